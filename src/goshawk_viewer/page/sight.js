// What is seen of a flight from where: on voxels alone, nothing is drawn for it.
'use strict';

// The share of the points that obstacles below the cut [m] hide from far away.
// @param way unit vector towards the eye
Goshawk.hiddenShare = function(map, cut, points, way) {
  if (!map || !points.length) return 0;
  const top = map.layersBelow(cut), [nx, ny] = map.size;
  const step = Math.max(1, Math.floor(points.length / 40));
  let hidden = 0, count = 0;
  for (let k = 0; k < points.length; k += step, ++count) {
    const at = points[k].map((c, i) => (c - map.origin[i]) / map.resolution);
    for (let s = 1; s < 400; ++s) {
      const [x, y, z] = at.map((c, i) => Math.floor(c + 0.7 * s * way[i]));
      if (x < 0 || y < 0 || z < 0 || x >= nx || y >= ny || z >= top) break;
      if (map.cells[x + nx * (y + ny * z)]) { ++hidden; break; }
    }
  }
  return hidden / count;
};

// The highest cut from which most of the points are seen from above: below ceilings, above trees.
Goshawk.bestCut = function(map, points) {
  const heights = points.map(p => p[2]).sort((a, b) => a - b);
  const highest = Math.min(map.upper(2), (heights.length ? heights[heights.length - 1] : map.upper(2)) + 0.3);
  const lowest = heights.length ? heights[heights.length >> 1] : highest;
  for (let cut = highest; cut > lowest; cut -= map.resolution) {
    if (Goshawk.hiddenShare(map, cut, points, [0, 0, 1]) < 0.1) return cut;
  }
  return points.length ? lowest : highest;
};

// The way from the points to the eye from where the fewest obstacles stand between.
// @param size [m] of the box around the points
Goshawk.bestWay = function(map, cut, points, size) {
  const across = Math.atan2(size[0], size[1]), length = V3.norm(size) + 1e-9;
  let best = null;
  for (let k = 0; k < 24; ++k) {
    for (const elevation of [0.6, 0.8, 1.0]) {
      const azimuth = 2 * Math.PI * k / 24, level = Math.cos(elevation);
      const way = [level * Math.cos(azimuth), level * Math.sin(azimuth), Math.sin(elevation)];
      // A long flight is best seen across; a low view shows more of the obstacles.
      const along = Math.abs(Math.sin(azimuth - across)) * Math.abs(size[0] - size[1]) / length;
      const cost = Goshawk.hiddenShare(map, cut, points, way) + 0.25 * along + 0.12 * (elevation - 0.6);
      if (!best || cost < best.cost) best = {cost, way};
    }
  }
  return best.way;
};
