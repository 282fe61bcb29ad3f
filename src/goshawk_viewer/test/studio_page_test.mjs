// Opens Foxglove Studio as `goshawk view --foxglove` serves it, in headless Chromium:
// node studio_page_test.mjs URL recording|live SCREENSHOT.png
import {check, end, kPatience, launch} from './browser.mjs';

const [url, kind, screenshot] = process.argv.slice(2);
const browser = await launch();
const page = await (await browser.newContext({viewport: {width: 1440, height: 900}})).newPage();
page.setDefaultTimeout(kPatience);
const strange = [], refused = [];
page.on('request', request => {
  const {protocol, hostname} = new URL(request.url());
  if (/^(http|ws)/.test(protocol) && hostname !== '127.0.0.1') strange.push(request.url());
});
page.on('response', response => { if (response.status() >= 400) refused.push(response.url()); });
const errors = [];
page.on('pageerror', error => errors.push(String(error)));
const there = text => page.getByText(text).first().waitFor().then(() => true, () => false);

// How many colours the 3D panel has, from the picture as it is seen.
async function colors() {
  // Of the page, not of the element: that would wait until the element rests, which it never does.
  const clip = await page.locator('canvas').first().boundingBox();
  const png = (await page.screenshot({clip, timeout: kPatience})).toString('base64');
  return page.evaluate(async data => {
    const image = new Image();
    image.src = 'data:image/png;base64,' + data;
    await image.decode();
    const c = document.createElement('canvas');
    c.width = image.width;
    c.height = image.height;
    const g = c.getContext('2d');
    g.drawImage(image, 0, 0);
    const pixels = new Uint32Array(g.getImageData(0, 0, c.width, c.height).data.buffer);
    return new Set(pixels).size;
  }, png);
}

await page.goto(url, {waitUntil: 'commit'});
check(await there('tracking error [m]'), 'our layout is loaded');
check(await there('Send this goal'), 'with a panel that sends a goal');
const {places} = await page.evaluate(async () => (await fetch('show.json')).json());
check(places.length > 3, `and a picture of where it flies: ${places.length} places`);
if (kind === 'recording') {
  // A click into the time bar jumps there: to the flight's end. Before the recording is open there
  // is no bar; a second click too early would begin the jump once more, so each waits twice as long.
  const arrived = page.getByText('"arrived"').first();
  let found = false;
  for (let wait_ms = 15000; wait_ms < 3 * kPatience && !found; wait_ms *= 2) {
    await page.mouse.click(1424, 843);
    found = await arrived.waitFor({timeout: wait_ms}).then(() => true, () => false);
  }
  check(found, 'a jump to the end finds that it arrived');
} else {
  check(await there('request_id'), 'live messages come');
  await page.getByRole('button', {name: 'Send this goal'}).click();
  await page.waitForTimeout(1000);  // who started this test looks where the goal went
}
let seen = 0;
for (let k = 0; k < 20 && seen < 800; ++k) {
  await page.waitForTimeout(500);
  seen = await colors();
}
check(seen >= 800, `map, corridor, trajectory and vehicle are drawn: ${seen} colours`);
if (screenshot) await page.screenshot({path: screenshot, timeout: kPatience});
check(strange.length === 0, `nothing from elsewhere is asked for: ${strange}`);
check(refused.length === 0, `all that it asks for is served: ${refused}`);
check(errors.length === 0, `no errors: ${errors}`);
await browser.close();
end();
