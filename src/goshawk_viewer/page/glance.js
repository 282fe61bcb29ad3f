// The state of a flight at one glance: what its figures are, without a page.
'use strict';

// [m] from a point to the nearest face of an occupied voxel, 0 inside one; Infinity if none is within `reach`.
Goshawk.nearestObstacle = (voxels, p, reach) => {
  const {origin, resolution, size, cells} = voxels;
  const cell = p.map((c, k) => (c - origin[k]) / resolution), most = reach / resolution;
  const range = cell.map((c, k) => [Math.max(0, Math.floor(c - most)),
                                    Math.min(size[k] - 1, Math.floor(c + most))]);
  const away = (c, k) => Math.max(k - c, c - k - 1, 0);
  let least = most * most;
  let found = false;
  for (let z = range[2][0]; z <= range[2][1]; ++z) {
    for (let y = range[1][0]; y <= range[1][1]; ++y) {
      const across = away(cell[2], z) ** 2 + away(cell[1], y) ** 2;
      if (across > least) continue;
      const row = size[0] * (y + size[1] * z);
      for (let x = range[0][0]; x <= range[0][1]; ++x) {
        const square = across + away(cell[0], x) ** 2;
        if (square > least || !cells[row + x]) continue;
        least = square;
        found = true;
      }
    }
  }
  return found ? Math.sqrt(least) * resolution : Infinity;
};

// What is left of a trajectory from a time since its start: [m] and [s].
Goshawk.wayLeft = (trajectory, t) => {
  const from = Math.min(Math.max(t, 0), trajectory.duration), left = trajectory.duration - from;
  const steps = Math.max(1, Math.ceil(left / 0.1));
  let length = 0, before = trajectory.sample(from).position;
  for (let k = 1; k <= steps; ++k) {
    const here = trajectory.sample(from + left * k / steps).position;
    length += V3.norm(V3.add(here, before, -1));
    before = here;
  }
  return {length, time: left + Math.max(0, -t)};
};

// Rows of names and values. @param s pose {p}, speed [m/s], mode, leg and now as the live page has them,
// obstacle [m] or null, mapAge [s] or null, battery 0 to 1 or null
Goshawk.glance = s => {
  const rows = [['mode', s.mode || 'no navigator']];
  if (!s.pose) return rows;
  rows.push(['position', s.pose.p.map(c => c.toFixed(2)).join(', ') + ' m'],
            ['altitude', s.pose.p[2].toFixed(2) + ' m'], ['speed', s.speed.toFixed(2) + ' m/s']);
  if (s.leg) {
    const left = Goshawk.wayLeft(s.leg.trajectory, s.now - s.leg.start);
    rows.push(['to go', `${left.length.toFixed(1)} m, ${left.time.toFixed(1)} s`]);
  }
  if (s.obstacle !== null) {
    rows.push(['nearest obstacle', s.obstacle === Infinity ? 'over 3 m' : s.obstacle.toFixed(2) + ' m']);
  }
  if (s.mapAge !== null) rows.push(['map', `${Math.max(0, s.mapAge).toFixed(1)} s old`]);
  if (s.battery !== null) rows.push(['battery', `${Math.round(100 * s.battery)} %`]);
  return rows;
};
