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

// When what is flown parts from the nominal part, and where it rests.
Goshawk.stopText = (leg, now) => {
  const t = now - leg.start, left = leg.trajectory.duration - t;
  if (left <= 0) return 'flown: at rest';
  const rests = `rests in ${left.toFixed(1)} s`;
  return t < leg.stopAfter ? `in ${(leg.stopAfter - t).toFixed(1)} s, ${rests}` : `is flown, ${rests}`;
};

// [m] the least distance from what is left of a commit, stop part included, to an obstacle: looked for at places
// 0.1 s apart; Infinity if nothing is within reach. @param leg as the live page has it
Goshawk.narrowest = (voxels, leg, now, reach) => {
  const {duration} = leg.trajectory, from = Math.min(Math.max(now - leg.start, 0), duration);
  const steps = Math.max(1, Math.min(60, Math.ceil((duration - from) / 0.1)));
  let least = Infinity;
  for (let k = 0; k <= steps; ++k) {
    const {position} = leg.trajectory.sample(from + (duration - from) * k / steps);
    least = Math.min(least, Goshawk.nearestObstacle(voxels, position, Math.min(reach, least)));
  }
  return least;
};

// Rows of names and values. @param s pose {p}, speed [m/s], mode, leg and now as the live page has them,
// obstacle and narrowest [m] or null, mapAge [s] or null, battery 0 to 1 or null
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
  if (s.narrowest !== null && s.narrowest !== undefined) {
    rows.push(['narrowest ahead', s.narrowest === Infinity ? 'over 1 m' : s.narrowest.toFixed(2) + ' m']);
  }
  if (s.leg && s.leg.stopAfter > 0) rows.push(['stop part', Goshawk.stopText(s.leg, s.now)]);
  if (s.mapAge !== null) rows.push(['map', `${Math.max(0, s.mapAge).toFixed(1)} s old`]);
  if (s.battery !== null) rows.push(['battery', `${Math.round(100 * s.battery)} %`]);
  return rows;
};
