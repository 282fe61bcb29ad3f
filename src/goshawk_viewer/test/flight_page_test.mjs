// Opens a flight's page in headless Chromium: node flight_page_test.mjs FLIGHT.html SCREENSHOT.png
import {pathToFileURL} from 'node:url';
import {check, end, launch, open, until} from './browser.mjs';

const [file, screenshot] = process.argv.slice(2);
const url = pathToFileURL(file).href;
const browser = await launch();
const loaded = page => until(page, () => window.goshawk);

async function lookAtIt() {
  const {page, complaints} = await open(browser, url);
  check(await loaded(page), 'the page starts');
  await picture(page);
  await time(page);
  await controls(page);
  await wholeFlight(page, 'wide');
  if (screenshot) await page.screenshot({path: screenshot});
  check(complaints.length === 0, `no complaints: ${complaints}`);
  await page.context().close();
}

async function picture(page) {
  const colors = await page.evaluate(() => goshawk.view.pixels().colors);
  check(colors > 1000, `a picture, not a blank: ${colors} colours`);
  const hidden = await page.evaluate(() => {
    const layers = Object.values(goshawk.view.layers), shown = layers.filter(layer => layer.visible);
    for (const layer of layers) layer.visible = false;
    const colors = goshawk.view.pixels().colors;
    for (const layer of shown) layer.visible = true;
    return colors;
  });
  check(hidden === 1, `without its layers it is one colour: ${hidden}`);
}

// The slider moves the vehicle along the flown track, with its attitude; play moves the slider.
async function time(page) {
  const slide = share => page.evaluate(share => {
    const slider = document.getElementById('time');
    slider.value = Number(slider.min) + share * (slider.max - slider.min);
    slider.dispatchEvent(new Event('input'));
    const b = goshawk.view.body, q = b.quaternion, t = goshawk.now;
    const near = goshawk.track.reduce((a, s) => Math.abs(s.t - t) < Math.abs(a.t - t) ? s : a);
    return {p: b.position.toArray(), tilt: Math.hypot(q.x, q.y),
            off: Math.hypot(...b.position.toArray().map((c, k) => c - near.p[k]))};
  }, share);
  const begin = await slide(0), middle = await slide(0.5), last = await slide(1);
  const distance = (a, b) => Math.hypot(...a.p.map((c, k) => c - b.p[k]));
  check(distance(begin, middle) > 1 && distance(middle, last) > 1,
        `the slider moves the vehicle: ${distance(begin, middle).toFixed(2)} m, ${distance(middle, last).toFixed(2)} m`);
  check(Math.max(begin.off, middle.off, last.off) < 0.05, 'it is where it was flown');
  const tilts = [];
  for (let k = 0; k <= 10; ++k) tilts.push((await slide(k / 10)).tilt);
  check(Math.max(...tilts) > 0.02, `it tilts to accelerate: ${Math.max(...tilts).toFixed(3)}`);
  await slide(0.95);
  await page.evaluate(() => document.getElementById('play').click());
  check(await until(page, () => goshawk.now >= goshawk.end && !goshawk.playing),
        'it plays to the end and stops');
  await slide(0.45);
}

async function controls(page) {
  const legend = await page.evaluate(() => {
    const box = document.getElementById('layer-corridor');
    box.click();
    return [goshawk.view.layers.corridor.visible, (box.click(), goshawk.view.layers.corridor.visible)];
  });
  check(!legend[0] && legend[1], 'the legend hides and shows');
  await page.focus('#time');
  const now = () => page.evaluate(() => goshawk.now - goshawk.begin);
  await page.keyboard.press('Home');
  const begin = await now();
  await page.keyboard.press('Shift+ArrowRight');
  check(begin === 0 && Math.abs(await now() - 1) < 1e-6, 'keys move through time');
  const eye = () => page.evaluate(() => goshawk.view.camera.position.toArray());
  const before = await eye();
  await page.keyboard.press('d');
  check(Math.hypot(...(await eye()).map((c, k) => c - before[k])) > 0.1, 'and turn the picture');
  await page.evaluate(() => document.getElementById('theme').click());
  check(await until(page, () => goshawk.view.pixels().colors > 1000), 'a light page as well');
}

// The first view shows all of the flight, beside the panel or below its header.
async function wholeFlight(page, width) {
  const out = await page.evaluate(() => {
    document.getElementById('home').click();
    const view = goshawk.view, r = view.canvas.getBoundingClientRect(), left = view.panelWidth();
    view.camera.updateMatrixWorld();
    return goshawk.framed().map(p => view.project(p))
        .filter(([x, y]) => x < left || x > r.right || y < r.top || y > r.bottom).length;
  });
  check(out === 0, `all of the flight is seen in a ${width} window: ${out} places are not`);
}

async function narrow() {
  const {page, complaints} = await open(browser, url, {size: {width: 390, height: 700}});
  await loaded(page);
  check(await page.isHidden('#folded'), 'a narrow window begins with the picture alone');
  await wholeFlight(page, 'narrow');
  await page.evaluate(() => document.getElementById('fold').click());
  check(await page.isVisible('#theme'), 'and has the panel when it is wanted');
  check(complaints.length === 0, `no complaints: ${complaints}`);
  await page.context().close();
}

async function withoutWebGL() {
  const {page, complaints} = await open(browser, url, {webgl: false});
  await loaded(page);
  check(await page.isVisible('#no-webgl'), 'without WebGL it says so');
  check(/WebGL/.test(await page.textContent('#no-webgl')), 'in clear words');
  const inked = await page.evaluate(() => {
    goshawk.setTime(goshawk.end / 2);
    goshawk.drawPlots();
    const c = document.querySelector('#plots canvas');
    return c.getContext('2d').getImageData(0, 0, c.width, c.height).data.some(v => v > 0);
  });
  check(inked, 'and still draws its plots');
  check(complaints.length === 0, `no complaints: ${complaints}`);
}

await lookAtIt();
await narrow();
await withoutWebGL();
await browser.close();
end();
