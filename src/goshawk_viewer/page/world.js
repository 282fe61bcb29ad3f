// A map that changes: which chunks of it must be drawn anew, and what changed last. No page needed.
'use strict';
Goshawk.kChunk = [64, 32, 32];  // [voxel] what is drawn anew together

// The chunk of a voxel, as a number.
Goshawk.chunkAt = (x, y, z) =>
    Math.floor(x / Goshawk.kChunk[0]) + 1024 * (Math.floor(y / Goshawk.kChunk[1]) +
    1024 * Math.floor(z / Goshawk.kChunk[2]));

// [[x, y, z], [x, y, z]): the voxels of a chunk.
Goshawk.chunkBox = (key, size) => {
  const at = [key % 1024, Math.floor(key / 1024) % 1024, Math.floor(key / 1048576)];
  const lower = at.map((c, i) => c * Goshawk.kChunk[i]);
  return [lower, lower.map((c, i) => Math.min(size[i], c + Goshawk.kChunk[i]))];
};

Goshawk.allChunks = size => {
  const keys = [];
  for (let z = 0; z < size[2]; z += Goshawk.kChunk[2]) {
    for (let y = 0; y < size[1]; y += Goshawk.kChunk[1]) {
      for (let x = 0; x < size[0]; x += Goshawk.kChunk[0]) keys.push(Goshawk.chunkAt(x, y, z));
    }
  }
  return keys;
};

// The changes of a map: the chunks to draw, and places with what became of them.
Goshawk.MapChanges = class {
  constructor(most = 20000) {
    this.most = most;  // places that are kept
    this.clear();
  }

  clear() {
    this.dirty = new Set();
    this.places = [];  // [[x, y, z] [voxel], kind: 'blocked', 'freed' or 'learnt']
  }

  // A voxel changed. Shades reach into its neighbours' chunks.
  add(x, y, z, kind) {
    const edge = ([c, size]) => c % size === 0 || c % size === size - 1;
    if (![[x, Goshawk.kChunk[0]], [y, Goshawk.kChunk[1]], [z, Goshawk.kChunk[2]]].some(edge)) {
      this.dirty.add(Goshawk.chunkAt(x, y, z));
    } else {
      this.spread(x, y, z);
    }
    if (this.places.length < this.most) this.places.push([[x, y, z], kind]);
  }

  spread(x, y, z) {
    for (const dx of [-1, 1]) for (const dy of [-1, 1]) for (const dz of [-1, 1]) {
      if (x + dx >= 0 && y + dy >= 0 && z + dz >= 0) this.dirty.add(Goshawk.chunkAt(x + dx, y + dy, z + dz));
    }
  }
};

// How a recorded map grew: both maps at any moment, forwards and backwards.
Goshawk.Growth = class {
  // @param data {origin, resolution, size, moments: [{t, obstacles, known}]}: runs of voxels that changed
  constructor({origin, resolution, size, moments}) {
    this.obstacles = new Goshawk.Voxels(origin, resolution, size);
    this.known = new Goshawk.Voxels(origin, resolution, size);
    this.moments = moments;
    this.at = 0;  // moments that are in the maps
  }

  // @param changes Goshawk.MapChanges that is told. @return whether anything changed
  seek(t, changes) {
    let wanted = 0;
    while (wanted < this.moments.length && this.moments[wanted].t <= t) ++wanted;
    wanted = Math.max(1, wanted);
    const before = this.at;
    while (this.at < wanted) this.flip(this.moments[this.at++], changes, this.at === wanted);
    while (this.at > wanted) this.flip(this.moments[--this.at], changes, false);
    return this.at !== before;
  }

  // The box that the map held at the moment that is shown: {origin, size, resolution}.
  window() {
    const [x, y, z, ...size] = this.moments[this.at - 1].window, {origin, resolution} = this.known;
    return {origin: V3.add(origin, [x, y, z], resolution), size, resolution};
  }

  flip(moment, changes, last) {
    if (!moment.bits) {  // read once
      moment.bits = [moment.obstacles, moment.known].map(Goshawk.runsOf);
      moment.obstacles = moment.known = null;
    }
    const [obstacles, known] = moment.bits, [nx, ny] = this.known.size;
    const tell = (at, kind) => {
      const x = at % nx, y = Math.floor(at / nx) % ny, z = Math.floor(at / (nx * ny));
      changes.add(x, y, z, kind);
    };
    if (last) changes.places = [];
    for (const [begin, end] of known) {
      for (let at = begin; at < end; ++at) {
        this.known.cells[at] ^= 1;
        tell(at, 'learnt');
      }
    }
    for (const [begin, end] of obstacles) {
      for (let at = begin; at < end; ++at) {
        this.obstacles.cells[at] ^= 1;
        tell(at, this.obstacles.cells[at] ? 'blocked' : 'freed');
      }
    }
    if (!last) changes.places = [];
  }
};

// The faces between what was seen to be free and what was never seen, as voxelFaces() has them.
Goshawk.frontierFaces = (known, obstacles, z0, z1, box) => {
  const [nx, ny, nz] = known.size, cell = [], face = [], ao = [];
  const free = (x, y, z) => {
    if (x < 0 || y < 0 || z < z0 || x >= nx || y >= ny || z >= z1 || z >= nz) return false;
    const at = x + nx * (y + ny * z);
    return known.cells[at] === 1 && obstacles.cells[at] === 0;
  };
  const [lower, upper] = box;
  for (let z = Math.max(lower[2], z0); z < Math.min(upper[2], z1); ++z) {
    for (let y = lower[1]; y < upper[1]; ++y) {
      for (let x = lower[0]; x < upper[0]; ++x) {
        if (known.cells[x + nx * (y + ny * z)]) continue;
        for (let k = 0; k < 6; ++k) {
          const step = k & 1 ? -1 : 1, axis = k >> 1;
          if (!free(x + (axis === 0) * step, y + (axis === 1) * step, z + (axis === 2) * step)) continue;
          cell.push(x, y, z);
          face.push(k);
          ao.push(3, 3, 3, 3);
        }
      }
    }
  }
  return {cell: new Uint16Array(cell), face: new Uint8Array(face), ao: new Uint8Array(ao)};
};
