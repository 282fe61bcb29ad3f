// Opens the live page in headless Chromium and flies from it, while others misbehave:
// node live_page_test.mjs URL BRIDGE X Y Z SCREENSHOT.png
import {check, end, kPatience, launch, open} from './browser.mjs';

const [url, bridge, x, y, z, screenshot] = process.argv.slice(2);
const goal = [x, y, z].map(Number);
const browser = await launch();
const {page, complaints} = await open(browser, url);
const wait = condition =>
    page.waitForFunction(condition, null, {timeout: kPatience}).then(() => true, () => false);

check(await wait(() => goshawk.view.maps.obstacles && goshawk.view.maps.grown && goshawk.pose),
      'map and vehicle come');
check(await wait(() => goshawk.view.pixels().colors > 500), 'the map is drawn');

// Aim at the goal's place and click there.
await page.evaluate(height => {
  const slider = document.getElementById('goal-height');
  slider.step = 0.01;
  slider.value = height;
  slider.dispatchEvent(new Event('input'));
}, goal[2]);
await page.click('#goal');
await page.mouse.click(...await page.evaluate(p => goshawk.view.project(p), goal));
check(await wait(() => goshawk.state.mode === 'flying'), 'the click makes it fly');
const sent = await page.evaluate(() => goshawk.sent);
check(Math.hypot(...sent.map((c, k) => c - goal[k])) < 0.05, `to where was clicked: ${sent}`);
check(await wait(() => goshawk.leg && goshawk.view.layers.trajectory.children.length > 0 &&
                       goshawk.view.layers.corridor.children.length > 0),
      'corridor and trajectory are drawn');

// Meanwhile other clients of the bridge misbehave; each is told why it is closed.
const closed = await page.evaluate(address => Promise.all(
    [s => s.send('garbage'), s => { for (let k = 0; k < 3000; ++k) s.send('{"op":"unsubscribe","subscriptionIds":[]}'); }]
        .map(misbehave => new Promise(resolve => {
          const socket = new WebSocket(address, ['foxglove.websocket.v1']);
          socket.onopen = () => misbehave(socket);
          socket.onclose = event => resolve(event.reason || `code ${event.code}`);
        }))), bridge);
check(/no message/.test(closed[0]), `garbage: ${closed[0]}`);
// Whose messages still lie unread when the connection ends gets a reset, and no reason.
check(/messages a second|code 1006/.test(closed[1]), `a flood: ${closed[1]}`);
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

await page.waitForTimeout(1200);
if (screenshot) await page.screenshot({path: screenshot});
check(await wait(() => goshawk.state.mode === 'arrived'), 'it arrives all the same');
// On a busy machine the next picture may come seconds later.
const drawn = await page.waitForFunction(
    p => Math.hypot(...goshawk.view.body.position.toArray().map((c, k) => c - p[k])) < 0.2, goal,
    {timeout: kPatience}).then(() => true, () => false);
check(drawn, 'the vehicle is drawn there');
const flown = await page.evaluate(() => goshawk.track.length);
check(flown > 50, `its track has ${flown} points`);
const off = await page.evaluate(() => goshawk.curves.speed.length);
check(off > 50, 'the plots are filled');
check(complaints.length === 0, `no complaints: ${complaints}`);
await browser.close();
end();
