// Opens the live page while scans change the map: node live_map_test.mjs URL
import {check, end, launch, open, until} from './browser.mjs';

const [url] = process.argv.slice(2);
const browser = await launch();
const {page, complaints} = await open(browser, url);
const look = () => page.evaluate(() => {
  const map = goshawk.view.maps.grown;
  return {version: map.version, blocked: map.cells.reduce((sum, c) => sum + c, 0)};
});

check(await until(page, () => window.goshawk && goshawk.view.maps.grown), 'the map comes');
await page.evaluate(() => document.getElementById('layer-grown').click());
check(await until(page, () => goshawk.view.pixels().colors > 100), 'it is drawn');
const before = await look();
await page.evaluate(() => { goshawk.mapUpdates = 0; });
check(await until(page, () => goshawk.mapUpdates > 1), 'scans change bricks of it');
const after = await look();
check(after.version > before.version, `versions go on: ${before.version}, ${after.version}`);
check(after.blocked < 50 * 50 * 20,
      `what scans see through is free: ${after.blocked} of 50000 voxels are blocked`);
check(await until(page, () => !goshawk.mapOld), 'what changed is drawn');
check(complaints.length === 0, `no complaints: ${complaints}`);
await browser.close();
end();
