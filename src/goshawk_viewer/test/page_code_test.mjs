// The page's code that needs no browser: node page_code_test.mjs MESSAGES.js PAGE_FOLDER
import {readFileSync} from 'node:fs';
import test from 'node:test';
import assert from 'node:assert/strict';

const [messages, page] = process.argv.slice(2);
const {Goshawk, V3} = new Function(
    ['geometry.js', 'theme.js', 'world.js', 'parts.js', 'octomap.js', 'sight.js', 'cdr.js', 'messages.js', 'glance.js', 'plots.js',
     'saved.js'].map(
        name => readFileSync(`${page}/${name}`, 'utf8')).join('\n') + '\nreturn {Goshawk, V3};')();

const kBox = {normals: [1, 0, 0, -1, 0, 0, 0, 1, 0, 0, -1, 0, 0, 0, 1, 0, 0, -1],
              offsets: [3, -1, 5, -2, 2, 1]};  // [1, 3] x [2, 5] x [-1, 2]

test('a box has six faces of four corners and its area', () => {
  const faces = Goshawk.polytopeFaces(kBox.normals, kBox.offsets);
  const area = face => face.slice(2).reduce((sum, p, k) => sum + V3.norm(V3.cross(
      V3.add(face[k + 1], face[0], -1), V3.add(p, face[0], -1))) / 2, 0);
  assert.deepEqual(faces.map(f => f.length), [4, 4, 4, 4, 4, 4]);
  assert.ok(Math.abs(faces.reduce((sum, f) => sum + area(f), 0) - 2 * (6 + 6 + 9)) < 1e-9);
});

test('a trajectory has the positions, velocities and accelerations of its curve', () => {
  // x = t^2 over two seconds, as a quintic; then on at its last speed.
  const square = [0, 0, 0.4, 1.2, 2.4, 4].map(x => [x, 0, 1]);
  const line = [0, 1, 2, 3, 4, 5].map(k => [4 + 0.8 * k, 0, 1]);
  const trajectory = new Goshawk.Trajectory(
      [{duration: 2, points: square}, {duration: 1, points: line}]);
  for (const t of [0, 0.3, 1.1, 1.9]) {
    const s = trajectory.sample(t);
    assert.ok(V3.norm(V3.add(s.position, [t * t, 0, 1], -1)) < 1e-9);
    assert.ok(V3.norm(V3.add(s.velocity, [2 * t, 0, 0], -1)) < 1e-9);
    assert.ok(V3.norm(V3.add(s.acceleration, [2, 0, 0], -1)) < 1e-9);
  }
  assert.ok(V3.norm(V3.add(trajectory.sample(9).position, [8, 0, 1], -1)) < 1e-9);
});

// Fifteen inner nodes along child 7 (all axes upwards), then one node of voxels at the upper end.
const cornerTree = bits => Uint8Array.from(
    [...Array(15).fill([0, 3 << 6]), [bits & 255, bits >> 8]].flat());

test('an OctoMap is read voxel by voxel, and what is cut off is refused', () => {
  // Child 0 is free, child 1 (x upwards) and child 6 (y and z upwards) are occupied.
  const tree = cornerTree(1 | 2 << 2 | 2 << 12);
  const voxels = Goshawk.octomapVoxels(tree, 0.5);
  assert.deepEqual(voxels.size, [2, 2, 2]);
  assert.deepEqual(voxels.origin, [16383, 16383, 16383]);
  assert.deepEqual(Array.from(voxels.cells), [0, 1, 0, 0, 0, 0, 1, 0]);
  for (let k = 1; k < tree.length; ++k) {
    assert.throws(() => Goshawk.octomapVoxels(tree.subarray(0, k), 0.5));
  }
  assert.throws(() => Goshawk.octomapVoxels(new Uint8Array(100000).fill(255), 0.5));
  assert.equal(Goshawk.octomapVoxels(new Uint8Array(0), 0.5), null);
});

test('the nearest obstacle is the one that brute force over all voxels finds', () => {
  const voxels = new Goshawk.Voxels([-1, 2, 0], 0.25, [20, 16, 12]);
  let seed = 7;
  const random = () => (seed = (seed * 16807) % 2147483647) / 2147483647;
  for (let k = 0; k < 60; ++k) voxels.cells[Math.floor(random() * voxels.cells.length)] = 1;
  const brute = p => {
    let least = Infinity;
    voxels.cells.forEach((cell, at) => {
      if (!cell) return;
      const i = [at % 20, Math.floor(at / 20) % 16, Math.floor(at / 320)];
      least = Math.min(least, V3.norm(i.map((c, k) => {
        const low = voxels.origin[k] + 0.25 * c;
        return Math.max(low - p[k], p[k] - low - 0.25, 0);
      })));
    });
    return least;
  };
  for (let k = 0; k < 300; ++k) {
    const p = [random() * 7 - 2, random() * 6 + 1, random() * 5 - 1];
    const expected = brute(p), found = Goshawk.nearestObstacle(voxels, p, 1.5);
    if (expected > 1.5) assert.equal(found, Infinity);
    else assert.ok(Math.abs(found - expected) < 1e-9, `${p}: ${found}, not ${expected}`);
  }
});

test('what is left of a flight is its length and time from now on', () => {
  const line = new Goshawk.Trajectory([{duration: 5, points: [0, 1, 2, 3, 4, 5].map(x => [2 * x, 0, 1])}]);
  const left = t => {
    const {length, time} = Goshawk.wayLeft(line, t);
    return [length, time].map(c => Math.round(1e6 * c) / 1e6);
  };
  assert.deepEqual(left(-1), [10, 6]);
  assert.deepEqual(left(2), [6, 3]);
  assert.deepEqual(left(9), [0, 0]);
});

test('of legs that replace each other the newest that had begun counts', () => {
  const leg = (start, duration) => ({start, trajectory: {duration}});
  const whole = leg(3, 10), again = leg(3 - 2e-6, 10), replaced = leg(90, 5), newest = leg(7, 8);
  const legs = [{start: 1, trajectory: null}, whole, again, replaced, newest];
  assert.equal(Goshawk.legAt(legs, 2), undefined);
  assert.equal(Goshawk.legAt(legs, 5), again);
  assert.equal(Goshawk.legAt(legs, 95), newest);
  assert.ok(Math.abs(Goshawk.plannedTime(legs) - 12) < 1e-5);
  assert.equal(Goshawk.plannedTime([leg(0, 2), leg(5, 2)]), 4, 'time between legs is nobody\'s');
});

test('the state at one glance leaves out what is not known', () => {
  const leg = {start: 10, trajectory: new Goshawk.Trajectory(
      [{duration: 5, points: [0, 1, 2, 3, 4, 5].map(x => [2 * x, 0, 1])}])};
  assert.deepEqual(Goshawk.glance({}), [['mode', 'no navigator']]);
  assert.deepEqual(
      Goshawk.glance({mode: 'flying', pose: {p: [1, 2, 3]}, speed: 0.5, leg, now: 12, obstacle: 0.456,
                      mapAge: 2.04, battery: 0.5}),
      [['mode', 'flying'], ['position', '1.00, 2.00, 3.00 m'], ['altitude', '3.00 m'],
       ['speed', '0.50 m/s'], ['to go', '6.0 m, 3.0 s'], ['nearest obstacle', '0.46 m'],
       ['map', '2.0 s old'], ['battery', '50 %']]);
  const names = rows => rows.map(([name]) => name);
  assert.deepEqual(names(Goshawk.glance({mode: 'idle', pose: {p: [1, 2, 3]}, speed: 0, obstacle: null,
                                         mapAge: null, battery: null})),
                   ['mode', 'position', 'altitude', 'speed']);
  assert.ok(Goshawk.glance({mode: 'idle', pose: {p: [1, 2, 3]}, speed: 0, obstacle: Infinity, mapAge: null,
                            battery: null}).some(([, value]) => value === 'over 3 m'));
});

function randomVoxels(size, share, seed) {
  const voxels = new Goshawk.Voxels([1, 2, 3], 0.5, size);
  const random = () => (seed = (seed * 16807) % 2147483647) / 2147483647;
  for (let k = 0; k < voxels.cells.length; ++k) voxels.cells[k] = random() < share ? 1 : 0;
  return voxels;
}
const facesAsText = ({cell, face, ao}) => Array.from(face, (f, k) =>
    [...cell.subarray(3 * k, 3 * k + 3), f, ...ao.subarray(4 * k, 4 * k + 4)].join()).sort();

test('the faces of all chunks are the faces of the whole', () => {
  const voxels = randomVoxels([70, 40, 37], 0.4, 5);
  const chunks = Goshawk.allChunks(voxels.size);
  assert.equal(chunks.length, 2 * 2 * 2);
  const parts = chunks.flatMap(key => facesAsText(
      Goshawk.voxelFaces(voxels, 3, 35, Goshawk.chunkBox(key, voxels.size))));
  assert.deepEqual(parts.sort(), facesAsText(Goshawk.voxelFaces(voxels, 3, 35)));
});

test('a changed voxel marks every chunk whose faces or shades it changes', () => {
  const voxels = randomVoxels([70, 40, 37], 0.4, 9);
  for (const [x, y, z] of [[10, 10, 10], [63, 31, 31], [64, 32, 32], [0, 31, 5], [63, 0, 36]]) {
    const faces = () => Goshawk.allChunks(voxels.size).map(key => facesAsText(
        Goshawk.voxelFaces(voxels, 0, 37, Goshawk.chunkBox(key, voxels.size))).join());
    const before = faces(), changes = new Goshawk.MapChanges();
    voxels.cells[x + 70 * (y + 40 * z)] ^= 1;
    changes.add(x, y, z, 'blocked');
    faces().forEach((text, k) => {
      const key = Goshawk.allChunks(voxels.size)[k];
      assert.ok(text === before[k] || changes.dirty.has(key), `${[x, y, z]} in chunk ${key}`);
    });
    assert.deepEqual(changes.places, [[[x, y, z], 'blocked']]);
  }
});

test('the border of the unseen lies between every unknown voxel and each free one beside it', () => {
  const known = randomVoxels([9, 8, 7], 0.5, 3), obstacles = randomVoxels([9, 8, 7], 0.3, 4);
  const at = (x, y, z) => x + 9 * (y + 8 * z);
  const inside = (x, y, z) => x >= 0 && y >= 0 && z >= 0 && x < 9 && y < 8 && z < 6;  // z: the cut
  let count = 0;
  for (let z = 0; z < 6; ++z) for (let y = 0; y < 8; ++y) for (let x = 0; x < 9; ++x) {
    if (known.cells[at(x, y, z)]) continue;
    for (const [i, j, k] of [[1, 0, 0], [-1, 0, 0], [0, 1, 0], [0, -1, 0], [0, 0, 1], [0, 0, -1]]) {
      if (inside(x + i, y + j, z + k) && known.cells[at(x + i, y + j, z + k)] &&
          !obstacles.cells[at(x + i, y + j, z + k)]) ++count;
    }
  }
  assert.equal(Goshawk.frontierFaces(known, obstacles, 0, 6, [[0, 0, 0], known.size]).face.length, count);
});

test('a map that grew is the same at a moment, from whichever side one comes', () => {
  // Runs of clear and set voxels of a row of ten, LEB128, base64.
  const runs = (...lengths) => Buffer.from(lengths).toString('base64');
  const moments = [[0.5, runs(2, 1, 7), runs(0, 5, 5)], [1, runs(10), runs(5, 5)], [2, runs(2, 1, 4, 1, 2), runs(10)]]
      .map(([t, obstacles, known], k) => ({t, obstacles, known, window: [k, 0, 0, 10 - k, 1, 1]}));
  const growth = new Goshawk.Growth({origin: [0, 0, 0], resolution: 0.5, size: [10, 1, 1], moments});
  const changes = new Goshawk.MapChanges();
  const look = t => {
    growth.seek(t, changes);
    return [growth.obstacles, growth.known].map(v => v.cells.join(''));
  };
  const expected = {'-1': ['0010000000', '1111100000'], 0.7: ['0010000000', '1111100000'],
                    1: ['0010000000', '1111111111'], 9: ['0000000100', '1111111111']};
  for (const t of [-1, 0.7, 1, 9, 1, -1, 9, 0.7, 9]) assert.deepEqual(look(t), expected[t], `at ${t} s`);
  assert.equal(growth.seek(8, changes), false, 'nothing changed');
  assert.deepEqual(growth.window(), {origin: [1, 0, 0], size: [8, 1, 1], resolution: 0.5});
  changes.clear();
  look(1);
  look(9);
  assert.deepEqual(changes.places, [[[2, 0, 0], 'freed'], [[7, 0, 0], 'blocked']]);
});

test('bricks change the voxels that they say, and tell which', () => {
  const voxels = randomVoxels([70, 9, 9], 0.5, 11), before = voxels.cells.slice();
  const words = new Uint8Array(512).fill(255), told = [];
  voxels.setBrick({word_x: 1, brick_y: 0, brick_z: 1}, words, (x, y, z, value) => told.push([x, y, z, value]));
  let changed = 0;
  voxels.cells.forEach((cell, at) => {
    const [x, y, z] = [at % 70, Math.floor(at / 70) % 9, Math.floor(at / 630)];
    const inBrick = x >= 64 && y < 8 && z >= 8;
    assert.equal(cell, inBrick ? 1 : before[at]);
    changed += cell !== before[at];
  });
  assert.equal(told.length, changed);
  assert.ok(told.every(([x, y, z, value]) => value === 1 && before[x + 70 * (y + 9 * z)] === 0));
});

const straight = (length, duration) => new Goshawk.Trajectory(
    [{duration, points: [0, 1, 2, 3, 4, 5].map(k => [length * k / 5, 0, 1])}]);

test('a commit parts where its stop part begins, and rests where that ends', () => {
  const stop = {duration: 1, points: [2, 2.2, 2.4, 2.5, 2.5, 2.5].map(x => [x, 0, 1])};
  const flown = new Goshawk.Trajectory([{duration: 2, points: [0, 0.4, 0.8, 1.2, 1.6, 2].map(x => [x, 0, 1])}, stop]);
  const leg = {start: 10, trajectory: flown, stopAfter: 2, nominal: straight(5, 5)};
  const parts = Goshawk.commitParts(leg);
  assert.ok(V3.norm(V3.add(parts.at, [2, 0, 1], -1)) < 1e-9);
  assert.ok(V3.norm(V3.add(parts.rest, [2.5, 0, 1], -1)) < 1e-9);
  assert.ok(V3.norm(V3.add(parts.nominal[0], [2, 0, 1], -1)) < 1e-9, 'the nominal part goes on from there');
  assert.ok(V3.norm(V3.add(parts.nominal.at(-1), [5, 0, 1], -1)) < 1e-9);
  assert.equal(Goshawk.commitParts({...leg, stopAfter: 0}), null);
  assert.deepEqual([10.5, 12.5, 14].map(t => Goshawk.stopText(leg, t)),
                   ['in 1.5 s, rests in 2.5 s', 'is flown, rests in 0.5 s', 'flown: at rest']);
});

test('the narrowest place ahead counts what is left of the flight alone', () => {
  const voxels = new Goshawk.Voxels([0, -2, 0], 0.5, [12, 8, 4]);
  const block = (x, y, z) => { voxels.cells[x + 12 * (y + 8 * z)] = 1; };
  block(1, 3, 2);   // [0.5, 1] x [-0.5, 0] x [1, 1.5]: on the way, at its beginning
  block(9, 5, 2);   // [4.5, 5] x [0.5, 1]: 0.5 m beside its end
  const leg = {start: 0, trajectory: straight(5, 5)};
  assert.equal(Goshawk.narrowest(voxels, leg, 0, 1), 0);
  assert.ok(Math.abs(Goshawk.narrowest(voxels, leg, 3, 1) - 0.5) < 1e-9);
  assert.equal(Goshawk.narrowest(voxels, leg, 3, 0.4), Infinity);
});

test('what is left out of a flight that plans anew is what newer plans replaced', () => {
  const leg = (start, duration) => ({start, trajectory: {duration}});
  const legs = [leg(0, 10), leg(2, 10), leg(2 - 1e-6, 9), {start: 3, trajectory: null}, leg(5, 4), leg(9.5, 1)];
  const parts = Goshawk.followedLegs(legs);
  assert.deepEqual(parts.map(p => [legs.indexOf(p.leg), Math.round(1e3 * p.until) / 1e3, p.whole]),
                   [[0, 2, false], [2, 3, false], [4, 4, true], [5, 1, true]]);
});

test('a moving box has twelve edges of its sizes, and its prediction grows by its bound', () => {
  const c = Math.SQRT1_2, edges = Goshawk.boxEdges([1, 2, 3], [c, 0, 0, c], [1, 2, 3]);  // turned by 90 degrees
  const axes = [0, 1, 2].map(i => edges.map(p => p[i]));
  const span = axes.map(a => [Math.min(...a), Math.max(...a)].map(v => Math.round(1e6 * v) / 1e6));
  assert.deepEqual(span, [[-1, 3], [1, 3], [0, 6]]);
  const lengths = Array.from({length: 12}, (_, k) => V3.norm(V3.add(edges[2 * k], edges[2 * k + 1], -1)));
  assert.deepEqual(lengths.map(Math.round).sort(), [2, 2, 2, 2, 4, 4, 4, 4, 6, 6, 6, 6]);
  const point = (x, y, z) => ({x, y, z});
  const box = Goshawk.predictedBox({
    id: 7, orientation: {w: 1, x: 0, y: 0, z: 0}, half_extents: point(0.25, 0.25, 1), error: 0.1, error_rate: 0.5,
    valid_until: 1, track: [{duration: 2, control_points: [point(0, 0, 1), point(4, 0, 1)]}]});
  const {line, boxes} = Goshawk.predictedShapes(box);
  assert.deepEqual(line.at(-1), [2, 0, 1], 'the track holds for one second of two');
  assert.deepEqual(boxes.map(b => b.half[0]), [0.25 + 0.1, 0.25 + 0.35, 0.25 + 0.6]);
  const rests = Goshawk.predictedShapes({...box, track: [{duration: 3, points: [[1, 1, 1]]}]});
  assert.deepEqual(rests.line.at(-1), [1, 1, 1], 'a track of one point stays there');
});

test('a cloud is placed in the map, and what it cannot hold is left out', () => {
  const data = new DataView(new ArrayBuffer(48)), put = (k, p) => p.forEach((c, i) => data.setFloat32(16 * k + 4 * i, c, true));
  put(0, [1, 0, 0]);
  put(1, [NaN, 0, 0]);
  put(2, [0, 2, 0]);
  const field = (name, offset) => ({name, offset, datatype: 7, count: 1});
  const m = {fields: [field('x', 0), field('y', 4), field('z', 8)], width: 3, height: 1, point_step: 16,
             is_bigendian: false, data: new Uint8Array(data.buffer)};
  assert.deepEqual(Array.from(Goshawk.cloudPlaces(m, null)), [1, 0, 0, 0, 2, 0]);
  const turned = Array.from(Goshawk.cloudPlaces(m, {p: [10, 0, 5], q: [Math.SQRT1_2, 0, 0, Math.SQRT1_2]}));
  assert.deepEqual(turned.map(c => Math.round(1e5 * c) / 1e5 + 0), [10, 1, 5, 8, 0, 5]);
  assert.equal(Goshawk.cloudPlaces({...m, width: 1000}, null).length, 6, 'a cloud that says too much');
  assert.equal(Goshawk.cloudPlaces({...m, fields: m.fields.slice(1)}, null), null);
  assert.equal(Goshawk.cloudPlaces({...m, fields: [{...field('x', 0), datatype: 8}, ...m.fields.slice(1)]}, null), null);
});

test('a ray meets the first voxel that small steps along it find', () => {
  const voxels = randomVoxels([12, 10, 8], 0.05, 21);
  let seed = 5, hits = 0;
  const random = () => (seed = (seed * 16807) % 2147483647) / 2147483647;
  for (let k = 0; k < 400; ++k) {
    const origin = [random() * 14 - 3, random() * 12 - 2, random() * 10 - 1];
    const to = [1 + random() * 6, 2 + random() * 5, 3 + random() * 4], along = V3.add(to, origin, -1);
    const way = along.map(c => c / V3.norm(along));
    let expected = null;
    for (let s = 0; s < 25 && expected === null; s += 1e-3) {
      const [x, y, z] = V3.add(origin, way, s).map((c, i) => Math.floor((c - voxels.origin[i]) / 0.5));
      const inside = x >= 0 && y >= 0 && z >= 0 && x < 12 && y < 10 && z < 6;  // z: the cut
      if (inside && voxels.cells[x + 12 * (y + 10 * z)]) expected = s;
    }
    const found = Goshawk.castRay(voxels, origin, way, 6);
    if (expected === null) {
      // A corner may be cut within a step.
      if (found) assert.ok(Math.min(...found.map((c, i) => Math.abs((c - voxels.origin[i]) / 0.5 % 1))) < 0.01);
      continue;
    }
    ++hits;
    const distance = V3.norm(V3.add(found, origin, -1));
    assert.ok(distance < expected + 1e-6 && distance > expected - 0.01, `${distance}, not ${expected}`);
  }
  assert.ok(hits > 50, `${hits} rays hit something`);
  const row = new Goshawk.Voxels([0, 0, 0], 1, [5, 1, 1]);
  row.cells[3] = 1;
  assert.deepEqual(Goshawk.castRay(row, [-2, 0.5, 0.5], [1, 0, 0]), [3, 0.5, 0.5]);
  assert.equal(Goshawk.castRay(row, [-2, 1.5, 0.5], [1, 0, 0]), null);
});

test('what is measured and saved is what was clicked and flown', () => {
  assert.equal(Goshawk.measureText([[0, 0, 1], [3, 4, 13]]), '13.00 m (level 5.00 m, up 12.00 m)');
  const track = [{t: 0, p: [1, 2, 3], v: [0.5, 0, 0]}, {t: 0.02, p: [1.01, 2, 3], v: [0.5, 0, 0]}];
  assert.equal(Goshawk.trackCsv(track), 't_s,x_m,y_m,z_m,vx_m_s,vy_m_s,vz_m_s\n0,1,2,3,0.5,0,0\n0.02,1.01,2,3,0.5,0,0\n');
});

test('plots are saved with their curves and limits at their values', () => {
  const plot = {title: 'speed', unit: 'm/s', limit: 2, scale: 1, span: [0, 10], zero: 0, top: 2.24, series: [
    {name: 'flown', color: '#123456', points: [[0, 0], [10, 2]], width: 1}]};
  const svg = Goshawk.plotsSvg([plot], {text: '#000', line: '#eee', limit: '#f00', back: '#fff'}, 'A & <B>');
  assert.match(svg, /A &amp; &lt;B>/);
  const [, x0, y0, x1, y1] = svg.match(/M([\d.]+) ([\d.]+)L([\d.]+) ([\d.]+)" fill="none" stroke="#123456"/).map(Number);
  const limit = Number(svg.match(/M60 ([\d.]+)H[\d.]+" stroke="#f00"/)[1]);
  assert.ok(x0 < x1 && y0 > y1);
  assert.ok(Math.abs(y1 - limit) < 0.01, 'the curve ends at the limit');
  assert.match(svg, />speed \[m\/s\]</);
});

test('a voxel in a corner has the faces that can be seen, and nooks', () => {
  const voxels = new Goshawk.Voxels([0, 0, 0], 1, [2, 1, 1]);
  voxels.cells.fill(1);
  assert.equal(Goshawk.voxelFaces(voxels, 0, 1).face.length, 10);
  assert.ok(Goshawk.voxelFaces(voxels, 0, 1).ao.every(openness => openness === 3));
});

test('a message is read by its schema, and one that is cut off is refused', () => {
  const schema = new Goshawk.Schema('uint32 id\nstring name\npkg/Point[] points\nfloat64[2] pair\n' +
                                    '====\nMSG: pkg/Point\nfloat64 x\n');
  const view = new DataView(new ArrayBuffer(60));
  view.setUint8(1, 1);                                // little endian
  view.setUint32(4, 7, true);
  view.setUint32(8, 3, true);
  'hi'.split('').forEach((c, k) => view.setUint8(12 + k, c.charCodeAt(0)));
  view.setUint32(16, 1, true);                        // one point, aligned to eight
  [2.5, 3.5, 4.5].forEach((x, k) => view.setFloat64(20 + 8 * k, x, true));
  assert.deepEqual(schema.read(view), {id: 7, name: 'hi', points: [{x: 2.5}], pair: [3.5, 4.5]});
  for (let size = 4; size < 44; ++size) {
    assert.throws(() => schema.read(new DataView(view.buffer, 0, size)), `${size} bytes`);
  }
});

function studio() {
  const converters = {}, module = {exports: {}};
  new Function('module', 'const kPlaces = [];\n' + readFileSync(messages, 'utf8'))(module);
  module.exports.activate({registerMessageConverter: c => { converters[c.fromSchemaName] = c.converter; }});
  return converters;
}
const stamp = sec => ({sec, nsec: 0});
const point = ([x, y, z]) => ({x, y, z});

test('the studio draws a plan as a corridor and a trajectory by speed', () => {
  const plan = {header: {stamp: stamp(1)}, stop_after: 0, stop_pieces: [], stop_polytopes: [], nominal: {
    request: {limits: {v_max: 2}}, polytopes: [kBox],
    pieces: [{duration: 1, control_points: [0, 1, 2, 3, 4, 5].map(k => point([0.4 * k, 3, 0]))}]}};
  const {entities} = studio()['goshawk_msgs/msg/CommittedTrajectory'](plan);
  const [corridor, trajectory, stop] = entities;
  assert.deepEqual([stop.lines, stop.spheres], [[], []], 'it has no stop part');
  assert.equal(corridor.lines[0].points.length, 2 * 24);  // each edge from both its faces
  assert.equal(corridor.triangles[0].indices.length, 3 * 12);
  const line = trajectory.lines[0];
  assert.deepEqual(line.points[line.points.length - 1], {x: 2, y: 3, z: 0});
  assert.equal(line.colors.length, line.points.length);
  assert.ok(line.colors[0].r > 0.9);  // at the limit
});

test('the studio draws the track that was flown, not across gaps, and takes back what is played again', () => {
  const draw = studio()['nav_msgs/msg/Odometry'];
  const at = (t, x) => draw({header: {stamp: stamp(t)}, pose: {pose: {
    position: point([x, 0, 1]), orientation: {x: 0, y: 0, z: 0, w: 1}}}}).entities[0].lines[0].points;
  at(1.0, 0);
  at(1.1, 1);
  assert.equal(at(1.2, 2).length, 4);
  assert.equal(at(5.0, 9).length, 4);  // a gap
  assert.equal(at(1.15, 5).length, 4);
  assert.deepEqual(at(1.2, 6).slice(-1)[0], {x: 6, y: 0, z: 1});
});

test('the studio draws the faces of a map, and counts what it draws', () => {
  const draw = studio()['octomap_msgs/msg/Octomap'];
  const {triangles} = draw({header: {stamp: stamp(1)}, data: cornerTree(2), resolution: 0.5}).entities[0];
  assert.equal(triangles[0].points.length, 6 * 4);
  assert.equal(globalThis.goshawkDrawn['octomap_msgs/msg/Octomap'], 1);
});

test('the studio draws a map as it grows, from updates that follow, twice a second', () => {
  const draw = studio(), words = (...set) => {
    const all = new BigUint64Array(64);
    for (const [y, z, bits] of set) all[y + 8 * z] = bits;
    return all;
  };
  const whole = {header: {stamp: stamp(1)}, version: 3, origin: point([0, 0, 0]), resolution: 1, size_x: 4, size_y: 8,
                 size_z: 8, grown: words(), known: words([0, 0, 3n]), raw: words([0, 0, 2n]), unknown_is_occupied: false};
  const faces = entities => entities.map(e => [e.id, e.triangles[0].points.length / 4]);
  // One obstacle; beside it one free voxel, with three unknown neighbours inside of the map.
  assert.deepEqual(faces(draw['goshawk_msgs/msg/VoxelGrid'](whole).entities),
                   [['obstacles seen', 6], ['edge of the unseen', 2]]);
  const update = (from, t, raw) => draw['goshawk_msgs/msg/VoxelGridUpdate']({
    header: {stamp: stamp(t)}, from_version: from, to_version: from + 1, shift_word_x: 0, shift_brick_y: 0, shift_brick_z: 0,
    bricks: [{word_x: 0, brick_y: 0, brick_z: 0, grown: words(), known: words([0, 0, 7n]), raw}]}).entities;
  assert.deepEqual(update(2, 2, words([0, 0, 6n])), [], 'one that does not follow');
  assert.deepEqual(faces(update(3, 2, words([0, 0, 6n]))), [['obstacles seen', 10], ['edge of the unseen', 2]]);
  assert.deepEqual(update(4, 2.2, words()), [], 'too soon');
  const again = draw['goshawk_msgs/msg/VoxelGrid'](whole);
  assert.deepEqual([again.entities, again.deletions.map(d => d.type)], [[], [1]], 'updates are drawn instead');
  assert.deepEqual(update(5, 2.6, words()), [], 'the older map came again');
  assert.deepEqual(faces(update(3, 2.6, words([0, 0, 4n]))).map(([, n]) => n), [6, 4]);
});

test('the studio draws what moves, its track and its bound', () => {
  const converters = studio(), q = {x: 0, y: 0, z: 0, w: 1};
  const moving = converters['goshawk_msgs/msg/MovingBoxes']({header: {stamp: stamp(1)}, boxes: [
    {id: 1, kind: '', pose: {position: point([1, 2, 3]), orientation: q}, half_extents: point([0.5, 1, 2])}]});
  assert.deepEqual(moving.entities[0].cubes[0].size, {x: 1, y: 2, z: 4});
  const {entities} = converters['goshawk_msgs/msg/PredictedObstacles']({header: {stamp: stamp(1)}, obstacles: [
    {id: 1, orientation: q, half_extents: point([1, 1, 1]), error: 0.5, error_rate: 0, valid_until: 1,
     track: [{duration: 1, control_points: [point([0, 0, 0]), point([3, 0, 0])]}]},
    {id: 2, orientation: q, half_extents: point([1, 1, 1]), error: 0, error_rate: 0, valid_until: 1, track: []}]});
  assert.equal(entities[0].lines.length, 1 + 3, 'one without a track is left out');
  assert.equal(Math.max(...entities[0].lines[3].points.map(p => p.x)), 4.5);
});
