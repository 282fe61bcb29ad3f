'use strict';
// An OctoMap tree without log-odds: two bits a child, depth first. @return Goshawk.Voxels, or null
Goshawk.octomapVoxels = function(data, resolution) {
  const leaves = [];
  const lower = [Infinity, Infinity, Infinity], upper = [-Infinity, -Infinity, -Infinity];
  let at = 0;
  const node = (x, y, z, size) => {
    if (at + 2 > data.length || size < 1) throw new Error('cut off');
    const bits = (data[at] & 255) | ((data[at + 1] & 255) << 8);
    at += 2;
    const half = size / 2, inner = [];
    for (let k = 0; k < 8; ++k) {
      const kind = (bits >> (2 * k)) & 3;
      if (!kind) continue;
      const p = [x + (k & 1 ? half : 0), y + (k & 2 ? half : 0), z + (k & 4 ? half : 0)];
      if (kind === 3) { inner.push(p); continue; }
      p.forEach((c, i) => { lower[i] = Math.min(lower[i], c); upper[i] = Math.max(upper[i], c + half); });
      if (kind === 2) leaves.push([p, half]);
    }
    for (const p of inner) node(p[0], p[1], p[2], half);
  };
  if (!data.length) return null;
  node(-32768, -32768, -32768, 65536);
  const size = upper.map((c, i) => c - lower[i]);
  if (!(size[0] > 0) || size[0] * size[1] * size[2] > 3e8) return null;
  const voxels = new Goshawk.Voxels(lower.map(c => c * resolution), resolution, size);
  for (const [p, edge] of leaves) {
    const [x, y, z] = p.map((c, i) => c - lower[i]);
    for (let k = z; k < z + edge; ++k) for (let j = y; j < y + edge; ++j) {
      const row = x + size[0] * (j + size[1] * k);
      voxels.cells.fill(1, row, row + edge);
    }
  }
  return voxels;
};
