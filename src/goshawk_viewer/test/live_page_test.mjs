// Opens the live page in headless Chromium and flies from it:
// node live_page_test.mjs URL BRIDGE X Y Z SCREENSHOT.png
import {check, end, launch, open, until} from './browser.mjs';

const [url, bridge, x, y, z, screenshot] = process.argv.slice(2);
const goal = [x, y, z].map(Number);
const browser = await launch();
const {page, complaints} = await open(browser, url, {size: {width: 1000, height: 700}});

check(await until(page, () => window.goshawk && goshawk.view.maps.obstacles &&
                              goshawk.view.maps.grown && goshawk.pose), 'map and vehicle come');
check(await until(page, () => goshawk.view.pixels().colors > 500), 'the map is drawn');
// Every state that comes, however late the page gets to show it.
await page.evaluate(() => {
  const take = goshawk.onNavigator;
  goshawk.seen = [];
  goshawk.onNavigator = m => { take.call(goshawk, m); goshawk.seen.push(goshawk.state.mode); };
});

// Aim at the goal's place and click there.
await page.evaluate(height => {
  const slider = document.getElementById('goal-height');
  slider.step = 0.01;
  slider.value = height;
  slider.dispatchEvent(new Event('input'));
  document.getElementById('goal').click();
}, goal[2]);
await page.mouse.click(...await page.evaluate(p => goshawk.view.project(p), goal));
check(await until(page, () => goshawk.seen.includes('flying')), 'the click makes it fly');
const sent = await page.evaluate(() => goshawk.sent);
check(Math.hypot(...sent.map((c, k) => c - goal[k])) < 0.05, `to where was clicked: ${sent}`);
check(await until(page, () => goshawk.leg && goshawk.view.layers.trajectory.children.length > 0 &&
                              goshawk.view.layers.corridor.children.length > 0),
      'corridor and trajectory are drawn');

// A page may send goals, and nothing else.
const told = await page.evaluate(address => new Promise(resolve => {
  const socket = new WebSocket(address, ['foxglove.websocket.v1']);
  socket.onopen = () => {
    socket.send(JSON.stringify({op: 'advertise', channels: [
      {id: 1, topic: 'command', encoding: 'json', schemaName: 'goshawk_msgs/msg/AttitudeSetpoint'}]}));
    socket.send(Uint8Array.of(1, 1, 0, 0, 0, 123, 125));  // {}
  };
  socket.onmessage = event => {
    const message = typeof event.data === 'string' ? JSON.parse(event.data) : {};
    if (message.op === 'status') { resolve(message.message); socket.close(); }
  };
}), bridge);
check(/may not publish/.test(told), `a command for the motors: ${told}`);

// Space holds it in flight; Resume flies on.
await page.evaluate(() => document.activeElement.blur());
await page.keyboard.press(' ');
check(await until(page, () => goshawk.seen.includes('held')), 'the space bar holds it');
check(await until(page, () => goshawk.speed < 0.05), 'it rests');
const before = await page.evaluate(() => goshawk.seen.length);
await page.click('#resume');
check(await until(page, from => goshawk.seen.slice(from).includes('flying'), before), 'Resume flies on');
const glance = await page.evaluate(() => document.getElementById('glance').innerText);
for (const name of ['mode', 'position', 'altitude', 'speed', 'to go', 'nearest obstacle', 'map']) {
  check(glance.includes(name), `the glance tells ${name}: ${glance.replaceAll('\n', ' ')}`);
}

check(await until(page, () => /vehicle (flies|hovers)/.test(document.getElementById('why').textContent)),
      `the page says why: ${await page.textContent('#why')}`);

if (screenshot) await page.screenshot({path: screenshot});
check(await until(page, () => goshawk.seen.includes('arrived')), 'it arrives');
check(await until(page, p => Math.hypot(
    ...goshawk.view.body.position.toArray().map((c, k) => c - p[k])) < 0.2, goal),
      'the vehicle is drawn there');
const {flown, plotted} = await page.evaluate(
    () => ({flown: goshawk.track.length, plotted: goshawk.curves.speed.length}));
check(flown > 20 && plotted > 20, `its track has ${flown} points, the plots ${plotted}`);
check(complaints.length === 0, `no complaints: ${complaints}`);
await browser.close();
end();
