// Shapes from numbers: voxels from runs of bits, faces of voxels, faces of polytopes, Bezier curves.
'use strict';
const Goshawk = {};

// The occupied runs [begin, end) of alternating lengths of free and occupied ones: LEB128, base64.
Goshawk.runsOf = text => {
  const bytes = Uint8Array.from(atob(text), c => c.charCodeAt(0)), runs = [];
  let at = 0, value = 0, k = 0;
  while (k < bytes.length) {
    let length = 0, scale = 1, byte;
    do {
      byte = bytes[k++];
      length += (byte & 127) * scale;
      scale *= 128;
    } while (byte & 128);
    if (value && length) runs.push([at, at + length]);
    at += length;
    value ^= 1;
  }
  return runs;
};

// A set of voxels: x fastest, one byte each. Outside of the grid counts as free here: only what
// can be seen is drawn.
Goshawk.Voxels = class {
  constructor(origin, resolution, size) {
    this.origin = origin;          // [m] map, lower corner of voxel (0, 0, 0)
    this.resolution = resolution;  // [m]
    this.size = size;
    this.cells = new Uint8Array(size[0] * size[1] * size[2]);
  }

  static fromRuns(map) {
    const voxels = new Goshawk.Voxels(map.origin, map.resolution, map.size);
    for (const [begin, end] of Goshawk.runsOf(map.runs)) voxels.cells.fill(1, begin, end);
    return voxels;
  }

  // Rows of 64-bit words as goshawk_msgs/VoxelGrid has them, as the bytes they are on the wire.
  static fromWords(origin, resolution, size, bytes) {
    const voxels = new Goshawk.Voxels(origin, resolution, size);
    const rowBytes = Math.ceil(size[0] / 64) * 8;
    for (let row = 0, at = 0; row < size[1] * size[2]; ++row) {
      for (let x = 0; x < size[0]; ++x, ++at) {
        voxels.cells[at] = (bytes[row * rowBytes + (x >> 3)] >> (x & 7)) & 1;
      }
    }
    return voxels;
  }

  // The same, of words as a BigUint64Array.
  static fromBigWords(origin, resolution, size, words) {
    const bytes = new Uint8Array(words.buffer, words.byteOffset, words.byteLength);
    return Goshawk.Voxels.fromWords(origin, resolution, size, bytes);
  }

  // The new content of 64 x 8 x 8 voxels, as goshawk_msgs/VoxelBrick has it: a word a row.
  // @param words of the brick; changed(x, y, z, value): told of each voxel that changes
  setBrick(brick, words = brick.grown, changed = () => {}) {
    const first = [64 * brick.word_x, 8 * brick.brick_y, 8 * brick.brick_z];
    const last = first.map((c, i) => Math.min(this.size[i], c + (i ? 8 : 64)));
    for (let z = first[2]; z < last[2]; ++z) for (let y = first[1]; y < last[1]; ++y) {
      const word = 8 * (8 * (z & 7) + (y & 7)), row = this.size[0] * (y + this.size[1] * z);
      for (let x = first[0]; x < last[0]; ++x) {
        const value = (words[word + ((x & 63) >> 3)] >> (x & 7)) & 1;
        if (this.cells[row + x] === value) continue;
        this.cells[row + x] = value;
        changed(x, y, z, value);
      }
    }
  }

  // The window moves by whole bricks, (64, 8, 8) voxels; what comes in is `value`, 0 or 1.
  moveWindow(bricks, value) {
    const by = [64 * bricks[0], 8 * bricks[1], 8 * bricks[2]];
    if (!by.some(v => v)) return;
    const [nx, ny, nz] = this.size, old = this.cells, inside = (i, n) => i >= 0 && i < n;
    this.cells = new Uint8Array(old.length).fill(value);
    for (let z = 0; z < nz; ++z) for (let y = 0; y < ny; ++y) {
      if (!inside(y + by[1], ny) || !inside(z + by[2], nz)) continue;
      const from = Math.min(nx, Math.max(0, by[0])), to = Math.max(0, Math.min(nx, nx + by[0]));
      const row = nx * (y + by[1] + ny * (z + by[2]));
      if (from < to) this.cells.set(old.subarray(row + from, row + to), nx * (y + ny * z) + from - by[0]);
    }
    this.origin = this.origin.map((o, axis) => o + this.resolution * by[axis]);
  }

  upper(axis) { return this.origin[axis] + this.size[axis] * this.resolution; }

  // How many layers lie below a height.
  layersBelow(z) {
    const n = Math.ceil((z - this.origin[2]) / this.resolution - 1e-6);
    return Math.max(0, Math.min(this.size[2], n));
  }
};

// Every face between an occupied voxel and a free one, of the layers [z0, z1), as if nothing were
// outside them. ao: how open each corner of the face is, 0 (in a nook) to 3.
// @param box [[x, y, z], [x, y, z]) of the voxels whose faces are wanted; default: all
Goshawk.voxelFaces = function(voxels, z0, z1, box = [[0, 0, 0], voxels.size]) {
  const [nx, ny, nz] = voxels.size;
  const cells = voxels.cells;
  const solid = (x, y, z) => x >= 0 && y >= 0 && z >= z0 && x < nx && y < ny && z < z1 &&
      cells[x + nx * (y + ny * z)] === 1;
  const cell = [], face = [], ao = [];
  const unit = [[1, 0, 0], [0, 1, 0], [0, 0, 1]];
  const [lower, upper] = box, first = Math.max(z0, lower[2]), last = Math.min(z1, upper[2]);
  for (let z = first; z < last; ++z) for (let y = lower[1]; y < upper[1]; ++y) for (let x = lower[0]; x < upper[0]; ++x) {
    if (!cells[x + nx * (y + ny * z)]) continue;
    for (let k = 0; k < 6; ++k) {
      const axis = k >> 1, step = k & 1 ? -1 : 1, n = unit[axis];
      const px = x + step * n[0], py = y + step * n[1], pz = z + step * n[2];
      if (solid(px, py, pz)) continue;
      const u = unit[(axis + 1) % 3], v = unit[(axis + 2) % 3];
      cell.push(x, y, z);
      face.push(k);
      for (let c = 0; c < 4; ++c) {
        const a = c & 1 ? 1 : -1, b = c & 2 ? 1 : -1;
        const ux = a * u[0], uy = a * u[1], uz = a * u[2], vx = b * v[0], vy = b * v[1], vz = b * v[2];
        const s = solid(px + ux, py + uy, pz + uz), t = solid(px + vx, py + vy, pz + vz);
        ao.push(s && t ? 0 : 3 - s - t - solid(px + ux + vx, py + uy + vy, pz + uz + vz));
      }
    }
  }
  return {cell: new Uint16Array(cell), face: new Uint8Array(face), ao: new Uint8Array(ao)};
};

const V3 = {
  add: (a, b, s = 1) => [a[0] + s * b[0], a[1] + s * b[1], a[2] + s * b[2]],
  dot: (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2],
  cross: (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]],
  norm: a => Math.hypot(a[0], a[1], a[2]),
  mix: (a, b, s) => [a[0] + s * (b[0] - a[0]), a[1] + s * (b[1] - a[1]), a[2] + s * (b[2] - a[2])],
};
Goshawk.V3 = V3;

// {p : A p <= b} as convex polygons, one a face: a wide square on each plane, cut by all others.
Goshawk.polytopeFaces = function(A, b) {
  const polygons = [];
  const rows = b.map((_, i) => A.slice(3 * i, 3 * i + 3));
  rows.forEach((n, i) => {
    const w = Math.abs(n[2]) < 0.9 ? [0, 0, 1] : [1, 0, 0];
    let u = V3.cross(n, w);
    u = u.map(c => c / V3.norm(u));
    const v = V3.cross(n, u);
    const middle = n.map(c => c * b[i]);
    const R = 1e3;
    let polygon = [[R, R], [-R, R], [-R, -R], [R, -R]].map(
        ([s, t]) => V3.add(V3.add(middle, u, s), v, t));
    rows.forEach((m, j) => {
      if (j !== i && polygon.length) polygon = cut(polygon, m, b[j]);
    });
    if (polygon.length >= 3) polygons.push(polygon);
  });
  return polygons;

  function cut(polygon, m, offset) {
    const kept = [];
    polygon.forEach((p, k) => {
      const q = polygon[(k + 1) % polygon.length];
      const dp = V3.dot(m, p) - offset, dq = V3.dot(m, q) - offset;
      if (dp <= 0) kept.push(p);
      if ((dp < 0 && dq > 0) || (dp > 0 && dq < 0)) kept.push(V3.mix(p, q, dp / (dp - dq)));
    });
    return kept;
  }
};

// A trajectory of Bezier pieces {duration, points: [[x, y, z], ...]}: position, velocity and
// acceleration by de Casteljau's scheme.
Goshawk.Trajectory = class {
  constructor(pieces) {
    this.pieces = pieces;
    this.duration = pieces.reduce((sum, piece) => sum + piece.duration, 0);
  }

  sample(t) {
    let rest = Math.max(0, Math.min(t, this.duration)), k = 0;
    while (k + 1 < this.pieces.length && rest > this.pieces[k].duration) {
      rest -= this.pieces[k++].duration;
    }
    const piece = this.pieces[k], T = piece.duration, s = Math.min(1, rest / T);
    let points = piece.points;
    const n = points.length - 1;
    let velocity = [0, 0, 0], acceleration = [0, 0, 0];
    while (points.length > 1) {
      if (points.length === 3) {
        acceleration = [0, 1, 2].map(
            i => n * (n - 1) / (T * T) * (points[2][i] - 2 * points[1][i] + points[0][i]));
      }
      if (points.length === 2) {
        velocity = [0, 1, 2].map(i => n / T * (points[1][i] - points[0][i]));
      }
      points = points.slice(1).map((q, i) => V3.mix(points[i], q, s));
    }
    return {position: points[0], velocity, acceleration};
  }
};

// The newest leg that had begun at a time, of legs in the order in which they were committed.
// Stamps of the same moment differ by microseconds from message to message.
Goshawk.legAt = (legs, t) => legs.findLast(l => l.trajectory && l.start <= t);

// What was followed of each leg: {leg, until [s] since its start, whole: no newer leg replaced it}; legs that
// were replaced at once are left out.
Goshawk.followedLegs = legs => {
  let next = Infinity;
  const parts = [];
  for (const leg of legs.filter(l => l.trajectory).reverse()) {
    const most = next - leg.start, whole = most >= leg.trajectory.duration;
    next = Math.min(next, leg.start);
    if (most > 0) parts.unshift({leg, until: Math.min(most, leg.trajectory.duration), whole});
  }
  return parts;
};

// Seconds of the plans, each until a newer one took over.
Goshawk.plannedTime = legs => Goshawk.followedLegs(legs).reduce((sum, part) => sum + part.until, 0);

// The first t seconds of a piece, as a piece of its own.
Goshawk.headOf = (piece, t) => {
  let points = piece.points;
  const left = [points[0]];
  while (points.length > 1) {
    points = points.slice(1).map((q, i) => V3.mix(points[i], q, t / piece.duration));
    left.push(points[0]);
  }
  return {duration: t, points: left};
};

// Of pieces as messages have them.
Goshawk.readPieces = pieces => new Goshawk.Trajectory(Array.from(
    pieces, p => ({duration: p.duration, points: p.control_points.map(c => [c.x, c.y, c.z])})));

// What is flown of a CommittedTrajectory when nothing newer comes: the nominal part up to
// stop_after, then the stop part, which begins there; without a stop part all of the nominal part.
Goshawk.flown = commit => {
  const read = pieces => Goshawk.readPieces(pieces).pieces;
  const nominal = read(commit.nominal.pieces);
  if (!(commit.stop_after > 0)) return new Goshawk.Trajectory(nominal);
  const pieces = [];
  let rest = commit.stop_after;
  for (const piece of nominal) {
    if (rest < 1e-9) break;
    pieces.push(rest < piece.duration ? Goshawk.headOf(piece, rest) : piece);
    rest -= piece.duration;
  }
  return new Goshawk.Trajectory([...pieces, ...read(commit.stop_pieces)]);
};
