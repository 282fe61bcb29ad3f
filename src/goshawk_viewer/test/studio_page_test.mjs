// Opens Foxglove Studio as `goshawk view --foxglove` serves it, in headless Chromium:
// node studio_page_test.mjs URL recording|live SCREENSHOT.png
import {check, end, launch, open, until} from './browser.mjs';

const [url, kind, screenshot] = process.argv.slice(2);
const browser = await launch();
// A link with a time jumps there: beyond the end of a recording, to its end.
const address = kind === 'recording' ? url + '?time=2100-01-01T00:00:00Z' : url;
const strange = [], refused = [], parts = [];
const {page, complaints} = await open(browser, address, {
  size: {width: 1000, height: 700},
  onRequest: request => {
    const {protocol, hostname} = new URL(request.url());
    if (/^(http|ws)/.test(protocol) && hostname !== '127.0.0.1') strange.push(request.url());
  },
  onResponse: response => {
    if (response.status() >= 400) refused.push(response.url());
    if (response.status() === 206) parts.push(response.url());
  },
});
const there = text => page.getByText(text).first().waitFor().then(() => true, () => false);

check(await there('tracking error [m]'), 'our layout is loaded');
check(await there('Send this goal'), 'with a panel that sends a goal');
const {places} = await page.evaluate(async () => (await fetch('show.json')).json());
check(places.length > 3, `and a picture of where it flies: ${places.length} places`);
if (kind === 'recording') {
  check(await there('flown_request_id'), 'a jump to the end shows the navigator');
  check(parts.length > 0, `the recording is asked for in parts: ${parts.length}`);
} else {
  check(await there('request_id'), 'live messages come');
  const button = page.getByRole('button', {name: 'Send this goal'});
  await button.dispatchEvent('click');
}
// The 3D panel asks for a drawing of each message that it shows.
const kinds = ['octomap_msgs/msg/Octomap', 'goshawk_msgs/msg/CommittedTrajectory',
               'goshawk_msgs/msg/Path', 'nav_msgs/msg/Odometry'];
check(await until(page, wanted => window.goshawkDrawn &&
                  wanted.every(kind => window.goshawkDrawn[kind] > 0), kinds),
      `map, corridor, path, trajectory and vehicle are drawn: ${JSON.stringify(
          await page.evaluate(() => window.goshawkDrawn))}`);
if (screenshot) await page.screenshot({path: screenshot});
check(strange.length === 0, `nothing from elsewhere is asked for: ${strange}`);
check(refused.length === 0, `all that it asks for is served: ${refused}`);
const errors = complaints.filter(c => c.startsWith('page: '));
check(errors.length === 0, `no errors: ${errors}`);
await browser.close();
end();
