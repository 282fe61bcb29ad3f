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
check(await until(page, () => !goshawk.mapOld && !goshawk.changes.dirty.size), 'what changed is drawn');

// What is drawn in parts is what would be drawn of the whole.
const parts = await page.evaluate(() => {
  const {view} = goshawk, {known, obstacles} = view.maps, whole = [[0, 0, 0], known.size];
  view.mapLayers.refresh(goshawk.changes.dirty);
  const drawn = layer => view.layers[layer].children.reduce((sum, mesh) => sum + mesh.geometry.maxInstancedCount, 0);
  const top = known.layersBelow(view.cut);
  return {obstacles: [drawn('obstacles'), Goshawk.voxelFaces(obstacles, 0, top).face.length],
          unseen: [drawn('unseen'), Goshawk.frontierFaces(known, obstacles, 0, top, whole).face.length]};
});
for (const [layer, [drawn, wanted]] of Object.entries(parts)) {
  check(drawn === wanted && drawn > 0, `${layer}: ${drawn} faces are drawn, ${wanted} are there`);
}
check(await until(page, () => goshawk.view.layers.movers.visible && goshawk.view.layers.movers.children.length > 4),
      'what moves is drawn, with its track and bound');
const person = await page.evaluate(() => [goshawk.moving.movers[0], goshawk.moving.predictions[0].error_rate]);
check(person[0].kind === 'person' && person[0].p[2] === 0.9 && person[1] === 0.2, 'as it was sent');
check(await until(page, () => goshawk.view.layers.cloud.children.length > 0), 'the cloud is drawn');
await page.evaluate(() => document.getElementById('layer-cloud').click());
check(await page.evaluate(() => goshawk.client.unread.has('points')), 'and no longer read when it is hidden');

// A click measures or sends a goal, never both.
const clicks = await page.evaluate(() => {
  const pressed = () => ['goal', 'measure'].map(id => document.getElementById(id).getAttribute('aria-pressed')).join();
  return ['goal', 'measure', 'goal', 'goal'].map(id => { document.getElementById(id).click(); return pressed(); });
});
check(clicks.join(' ') === 'true,false false,true true,false false,false', `what a click does: ${clicks}`);
check(complaints.length === 0, `no complaints: ${complaints}`);
await browser.close();
end();
