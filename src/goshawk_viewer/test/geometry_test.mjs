// What the pages compute of a committed trajectory, without a browser: node geometry_test.mjs PAGE_FOLDER
import assert from 'node:assert';
import {readFileSync} from 'node:fs';
import vm from 'node:vm';

const source = readFileSync(`${process.argv[2]}/geometry.js`, 'utf8');
const {Goshawk} = vm.runInNewContext(`${source}; ({Goshawk})`);

// From x to x + 1 along a line, with these distances of the control points from x.
const piece = (x, duration, ...along) => ({
  duration, control_points: along.map(d => ({x: x + d, y: 2 * d, z: 1}))});
const nominal = {pieces: [piece(0, 2, 0, 0, 0, 0.2, 0.6, 1), piece(1, 3, 0, 0.6, 1, 1, 1, 1)]};
const near = (a, b, what) => a.forEach(
    (value, i) => assert.ok(Math.abs(value - b[i]) < 1e-12, `${what}: ${a} is not ${b}`));

const whole = Goshawk.flown({nominal, stop_after: 0, stop_pieces: []});
assert.equal(whole.pieces.length, 2);
assert.equal(whole.duration, 5);

for (const stop_after of [0.5, 2, 3.5, 5]) {
  const stop = piece(7, 1.5, 0, 0, 0, 1, 1, 1);
  const flown = Goshawk.flown({nominal, stop_after, stop_pieces: [stop]});
  assert.equal(flown.duration, stop_after + 1.5);
  assert.equal(flown.pieces.length, stop_after <= 2 ? 2 : 3, 'no piece of no length');
  for (let t = 0; t < stop_after; t += 0.1) {
    const a = flown.sample(t), b = whole.sample(t);
    near(a.position, b.position, `position at ${t} s`);
    a.velocity.forEach((v, i) => assert.ok(Math.abs(v - b.velocity[i]) < 1e-9, `velocity at ${t} s`));
  }
  near(flown.sample(stop_after + 1.5).position, [8, 2, 1], 'the end of the stop part');
}
console.log('geometry: all holds');
