// Stages' messages as scenes for Foxglove's 3D panel, without visualizer and markers.
// scripts/bundle.py puts theme.js, geometry.js, octomap.js and sight.js before it, main.js the places
// to look at, kPlaces: [[x, y, z], ...]. Frame map, [m].
'use strict';

const kZero = {sec: 0, nsec: 0};
const kStill = {position: {x: 0, y: 0, z: 0}, orientation: {x: 0, y: 0, z: 0, w: 1}};
const kMostFaces = 400000;  // of a map
const kGap_s = 0.5;         // a flown track with a longer gap is not joined across it

const xyz = p => [p.x, p.y, p.z];
const point = p => ({x: p[0], y: p[1], z: p[2]});
const seconds = stamp => stamp.sec + 1e-9 * (stamp.nsec === undefined ? stamp.nanosec : stamp.nsec);
const rgba = (rgb, a = 1) => ({r: rgb[0], g: rgb[1], b: rgb[2], a});
const hex = (color, a = 1) =>
    rgba([16, 8, 0].map(shift => ((color >> shift) & 255) / 255), a);

function entity(id, timestamp, parts, frame_id = 'map') {
  return {id, timestamp, frame_id, frame_locked: true, lifetime: kZero, metadata: [], arrows: [],
          cubes: [], spheres: [], cylinders: [], lines: [], triangles: [], texts: [], models: [], ...parts};
}
const scene = entities => ({deletions: [], entities});

// type: 0 strip, 2 pairs of points
function line(points, thickness, color, {colors = [], type = 0, scale_invariant = false} = {}) {
  return {type, pose: kStill, thickness, scale_invariant, points: points.map(point), color, colors,
          indices: []};
}
const triangles = (points, indices, color, colors = []) =>
    ({pose: kStill, points: points.map(point), color, colors, indices});

// The visible faces of a map below what hides the places, brighter the higher, darker in nooks.
function mapTriangles(voxels, low, high, opacity) {
  const top = kPlaces.length ? voxels.layersBelow(Goshawk.bestCut(voxels, kPlaces)) : voxels.size[2];
  const faces = Goshawk.voxelFaces(voxels, 0, top);
  const points = [], colors = [], indices = [], unit = [[1, 0, 0], [0, 1, 0], [0, 0, 1]];
  const count = Math.min(faces.face.length, kMostFaces);
  for (let f = 0; f < count; ++f) {
    const axis = faces.face[f] >> 1, way = faces.face[f] & 1 ? 0 : 1;
    const u = unit[(axis + 1) % 3], v = unit[(axis + 2) % 3];
    const cell = Array.from(faces.cell.subarray(3 * f, 3 * f + 3));
    const corner = V3.add(cell, unit[axis], way);
    const shade = [0.72, 0.8, 1][axis] * (axis === 2 && !way ? 0.6 : 1);
    const color = V3.mix(low, high, cell[2] / voxels.size[2]).map(c => c * shade);
    for (let c = 0; c < 4; ++c) {
      const p = V3.add(V3.add(corner, u, c & 1), v, c >> 1);
      points.push(p.map((x, i) => voxels.origin[i] + x * voxels.resolution));
      colors.push(rgba(color.map(x => x * (0.6 + 0.4 * faces.ao[4 * f + c] / 3)), opacity));
    }
    const k = 4 * f;
    indices.push(...(way ? [k, k + 1, k + 3, k, k + 3, k + 2] : [k, k + 3, k + 1, k, k + 2, k + 3]));
  }
  return triangles(points, indices, rgba(high, opacity), colors);
}

// The same map comes again with every jump in time: its triangles are kept.
function remembered(make) {
  let last = null, made = null;
  const same = (a, b) => a.length === b.length && a.every((x, i) => x === b[i]);
  return (data, message) => {
    if (!last || !same(last, data)) { last = data.slice(); made = make(message); }
    return made;
  };
}

const shade = color => { const {r, g, b} = hex(color); return [r, g, b]; };
const kTheme = Goshawk.themes.dark;

const obstaclesOnce = remembered(m => {
  const voxels = Goshawk.octomapVoxels(m.data, m.resolution);
  return voxels ? [mapTriangles(voxels, shade(kTheme.low), shade(kTheme.high), 1)] : [];
});
const grownOnce = remembered(m => {
  const voxels = Goshawk.Voxels.fromBigWords(
      xyz(m.origin), m.resolution, [m.size_x, m.size_y, m.size_z], m.grown);
  return [mapTriangles(voxels, shade(kTheme.grown), shade(kTheme.grown), 0.12)];
});

const obstacles = m => scene([entity('obstacles', m.header.stamp, {triangles: obstaclesOnce(m.data, m)})]);
const grown = m => scene([entity('grown', m.header.stamp, {triangles: grownOnce(m.grown, m)})]);

function path(m) {
  return scene([
    entity('path as searched', m.header.stamp,
           {lines: [line(m.raw.map(xyz), 0.02, hex(kTheme.raw, 0.8))]}),
    entity('pruned path', m.header.stamp,
           {lines: [line(m.waypoints.map(xyz), 0.03, hex(kTheme.pruned))],
            spheres: m.waypoints.map(p => ({
              pose: {position: p, orientation: kStill.orientation}, size: {x: 0.1, y: 0.1, z: 0.1},
              color: hex(kTheme.pruned)}))}),
  ]);
}

function corridorParts(polytopes) {
  const faces = [], indices = [], edges = [];
  for (const {normals, offsets} of polytopes) {
    for (const polygon of Goshawk.polytopeFaces(Array.from(normals), Array.from(offsets))) {
      const first = faces.length;
      faces.push(...polygon);
      polygon.forEach((p, k) => {
        edges.push(p, polygon[(k + 1) % polygon.length]);
        if (k > 1) indices.push(first, first + k - 1, first + k);
      });
    }
  }
  return {triangles: [triangles(faces, indices, hex(kTheme.corridor, 0.05))],
          lines: [line(edges, 1, hex(kTheme.corridor, 0.55), {type: 2, scale_invariant: true})]};
}

function committed(m) {
  const v_max = m.nominal.request.limits.v_max;
  const polytopes = [...m.nominal.polytopes, ...m.stop_polytopes];
  const trajectory = Goshawk.flown(m);
  const steps = Math.max(2, Math.ceil(trajectory.duration / 0.04)), points = [], colors = [];
  for (let k = 0; k <= steps; ++k) {
    const s = trajectory.sample(trajectory.duration * k / steps);
    points.push(s.position);
    colors.push(rgba(Goshawk.speedColor(V3.norm(s.velocity) / v_max)));
  }
  return scene([entity('corridor', m.header.stamp, corridorParts(polytopes)),
                entity('trajectory', m.header.stamp, {lines: [line(points, 0.06, rgba([1, 1, 1]), {colors})]})]);
}

// Arms and rotors, as they are turned.
function vehicleParts(pose, radius = 0.15) {
  const at = xyz(pose.position), o = pose.orientation, q = [o.x, o.y, o.z];
  const turned = v => {
    const twice = V3.cross(q, v).map(c => 2 * c);
    return point(V3.add(at, V3.add(V3.add(v, twice, o.w), V3.cross(q, twice))));
  };
  const part = (p, size, color) => ({
    pose: {position: turned(p), orientation: o}, size: point(size), color});
  const d = 0.43 * radius, w = 0.72 * radius;
  const corners = [[d, d], [d, -d], [-d, d], [-d, -d]];
  return {
    cylinders: corners.map(([x, y]) => ({
      ...part([x, y, 0.1 * radius], [w, w, 0.03 * radius], hex(x > 0 ? kTheme.accent : kTheme.body, 0.75)),
      bottom_scale: 1, top_scale: 1})),
    cubes: [part([0, 0, 0], [0.7 * radius, 0.4 * radius, 0.25 * radius], hex(kTheme.body))]};
}

// The track so far; what is played again is removed first.
const track = [];
function flown(m) {
  const t = seconds(m.header.stamp), last = () => track[track.length - 1];
  while (track.length && last().t >= t) track.pop();
  if (!track.length || t - last().t >= 0.03) track.push({t, p: xyz(m.pose.pose.position)});
  if (track.length > 8000) track.splice(0, 4000);
  const pairs = [];
  for (let k = 1; k < track.length; ++k) {
    if (track[k].t - track[k - 1].t < kGap_s) pairs.push(track[k - 1].p, track[k].p);
  }
  return scene([
    entity('flown track', m.header.stamp, {lines: [
      line(pairs, 2, hex(kTheme.flown), {type: 2, scale_invariant: true})]}),
    entity('vehicle', m.header.stamp, vehicleParts(m.pose.pose))]);
}

module.exports.activate = context => {
  const draws = {'octomap_msgs/msg/Octomap': obstacles, 'goshawk_msgs/msg/VoxelGrid': grown,
                 'goshawk_msgs/msg/Path': path, 'goshawk_msgs/msg/CommittedTrajectory': committed,
                 'nav_msgs/msg/Odometry': flown};
  // How many of each kind were drawn, for tests.
  const drawn = globalThis.goshawkDrawn = {};
  for (const [fromSchemaName, draw] of Object.entries(draws)) {
    drawn[fromSchemaName] = 0;
    const converter = message => {
      const picture = draw(message);
      drawn[fromSchemaName] += 1;
      return picture;
    };
    context.registerMessageConverter({fromSchemaName, toSchemaName: 'foxglove.SceneUpdate', converter});
  }
};
