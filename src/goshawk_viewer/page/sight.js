// The best view of a flight, computed from the voxels alone.
'use strict';

// The share of the points that obstacles below the cut [m] hide from a distant eye.
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

// The direction of a flight's long side. @return {angle [rad], stretch: 0 round, 1 a line}
Goshawk.longSide = function(points) {
  const middle = points.reduce((s, p) => V3.add(s, p, 1 / points.length), [0, 0, 0]);
  let xx = 0, yy = 0, xy = 0;
  for (const p of points) {
    const [x, y] = V3.add(p, middle, -1);
    xx += x * x; yy += y * y; xy += x * y;
  }
  return {angle: 0.5 * Math.atan2(2 * xy, xx - yy), stretch: Math.hypot(xx - yy, 2 * xy) / (xx + yy + 1e-9)};
};

// The direction from the points to the eye with the fewest obstacles in between.
// @param tall is the picture higher than wide?
Goshawk.bestWay = function(map, cut, points, tall) {
  const {angle, stretch} = Goshawk.longSide(points);
  let best = null;
  for (let k = 0; k < 24; ++k) {
    for (const elevation of map ? [0.6, 0.8, 1.0] : [0.9]) {
      const azimuth = 2 * Math.PI * k / 24 - 0.75 * Math.PI, level = Math.cos(elevation);
      const way = [level * Math.cos(azimuth), level * Math.sin(azimuth), Math.sin(elevation)];
      // A long flight is best seen across, but upright in a tall picture; a low view shows more of
      // the obstacles.
      const along = stretch * Math.abs(tall ? Math.sin(azimuth - angle) : Math.cos(azimuth - angle));
      const cost = Goshawk.hiddenShare(map, cut, points, way) + 0.25 * along + 0.06 * (elevation - 0.6);
      if (!best || cost < best.cost - 1e-9) best = {cost, way};
    }
  }
  return best.way;
};

// Places a camera that looks from `way` so that all points fill a part of its picture. Moves the
// target, which is the middle of the points at first.
// @param free {left, right, bottom, top} of the picture, -1 to 1
Goshawk.fit = function(camera, target, way, points, free, closest) {
  const reach = Math.max(...points.map(p => target.distanceTo(p)));
  const right = new G3.Vector3(), up = new G3.Vector3(), spot = new G3.Vector3();
  let distance = 4 * reach + closest;
  for (let k = 0; k < 10; ++k) {
    camera.position.copy(target).addScaledVector(way, distance);
    camera.lookAt(target);
    camera.updateMatrixWorld();
    const lower = [Infinity, Infinity], upper = [-Infinity, -Infinity];
    for (const p of points) {
      spot.copy(p).project(camera);
      [spot.x, spot.y].forEach((c, i) => { lower[i] = Math.min(lower[i], c); upper[i] = Math.max(upper[i], c); });
    }
    camera.matrixWorld.extractBasis(right, up, spot);
    const half = Math.tan(camera.fov * Math.PI / 360) * distance;
    target.addScaledVector(right, half * camera.aspect * (lower[0] + upper[0] - free.left - free.right) / 2);
    target.addScaledVector(up, half * (lower[1] + upper[1] - free.bottom - free.top) / 2);
    const scale = Math.max((upper[0] - lower[0]) / (free.right - free.left),
                           (upper[1] - lower[1]) / (free.top - free.bottom));
    distance = Math.max(closest, 1.1 * reach, distance * Math.max(0.4, Math.min(2.5, scale)));
  }
};
