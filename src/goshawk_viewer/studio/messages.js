// Stages' messages as scenes for Foxglove's 3D panel, without visualizer and markers.
// scripts/bundle.py puts theme.js, geometry.js, world.js, parts.js, messages.js, octomap.js and sight.js before it, main.js the places
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
// @param wanted the faces, if not all
function mapTriangles(voxels, low, high, opacity, wanted = null) {
  const top = kPlaces.length ? voxels.layersBelow(Goshawk.bestCut(voxels, kPlaces)) : voxels.size[2];
  const faces = wanted || Goshawk.voxelFaces(voxels, 0, top);
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

// How many messages of each kind were drawn, here and for tests.
const drawn = globalThis.goshawkDrawn = {};

const shade = color => { const {r, g, b} = hex(color); return [r, g, b]; };
const kTheme = Goshawk.themes.dark;

const obstaclesOnce = remembered(m => {
  const voxels = Goshawk.octomapVoxels(m.data, m.resolution);
  return voxels ? [mapTriangles(voxels, shade(kTheme.low), shade(kTheme.high), 1)] : [];
});
// The vehicle's map as it was last said to be; updates that follow are drawn twice a second.
const kRedraw_s = 0.5;
let map = null;  // {grown, known, obstacles: Voxels, drawn [s]}

function wholeMap(m) {
  const read = words => Goshawk.Voxels.fromBigWords(xyz(m.origin), m.resolution, [m.size_x, m.size_y, m.size_z], words);
  const seen = m.raw && m.raw.length > 0 && m.known.length > 0;
  map = {version: m.version, unknown: m.unknown_is_occupied ? 1 : 0, drawn: -Infinity, grown: read(m.grown),
         known: seen ? read(m.known) : null, obstacles: seen ? read(m.raw) : null};
}

const bytesOf = words => new Uint8Array(words.buffer, words.byteOffset, words.byteLength);

// @return whether the map was drawn long enough ago
function updateMap(m) {
  if (!map || map.version !== m.from_version) return false;
  const shift = [m.shift_word_x, m.shift_brick_y, m.shift_brick_z];
  map.grown.moveWindow(shift, map.unknown);
  if (map.known) for (const voxels of [map.known, map.obstacles]) voxels.moveWindow(shift, 0);
  for (const brick of m.bricks) {
    map.grown.setBrick(brick, bytesOf(brick.grown));
    if (!map.known) continue;
    map.known.setBrick(brick, bytesOf(brick.known));
    map.obstacles.setBrick(brick, bytesOf(brick.raw));
  }
  map.version = m.to_version;
  const t = seconds(m.header.stamp);
  if (t - map.drawn < kRedraw_s && t >= map.drawn) return false;
  map.drawn = t;
  return true;
}

// What was measured so far, and the edge of the unseen.
function mapEntities(stamp) {
  if (!map.known && drawn['octomap_msgs/msg/Octomap']) return [];  // its obstacles are drawn already
  if (!map.known) return [entity('grown', stamp, {triangles: [mapTriangles(map.grown, shade(kTheme.grown), shade(kTheme.grown), 0.12)]})];
  const edge = Goshawk.frontierFaces(map.known, map.obstacles, 0, map.known.size[2], [[0, 0, 0], map.known.size]);
  return [
    entity('obstacles seen', stamp, {triangles: [mapTriangles(map.obstacles, shade(kTheme.low), shade(kTheme.high), 1)]}),
    entity('edge of the unseen', stamp, {triangles: [
      mapTriangles(map.known, shade(kTheme.unseen), shade(kTheme.unseen), 0.10, edge)]})];
}

const obstacles = m => scene([entity('obstacles', m.header.stamp, {triangles: obstaclesOnce(m.data, m)})]);
// Whole maps come again, also with every jump in time. Once updates are drawn, whole maps are not: theirs is
// another topic, and both would stay.
let updatesDrawn = false;
function grown(m) {
  if (!map || map.version !== m.version) wholeMap(m);
  if (!updatesDrawn) return scene(mapEntities(m.header.stamp));
  return {deletions: [{timestamp: m.header.stamp, type: 1, id: ''}], entities: []};
}
function updated(m) {
  if (!updateMap(m)) return scene([]);
  updatesDrawn = true;
  return scene(mapEntities(m.header.stamp));
}

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

// Where the commit parts, its nominal part from there, and its stop part; nothing if it has none.
function stopParts(m, trajectory) {
  const nominal = m.stop_after > 0 ? Goshawk.readPieces(m.nominal.pieces) : null;
  const parts = Goshawk.commitParts({trajectory, stopAfter: m.stop_after, nominal});
  if (!parts) return {};
  const ball = (p, d) => ({pose: {position: point(p), orientation: kStill.orientation}, size: point([d, d, d]),
                           color: hex(kTheme.stop)});
  return {lines: [line(parts.nominal, 0.03, hex(kTheme.nominal, 0.8)), line(parts.stop, 0.08, hex(kTheme.stop))],
          spheres: [ball(parts.at, 0.12), ball(parts.rest, 0.18)]};
}

// Boxes that move, as they are.
function movers(m) {
  const cubes = m.boxes.map(b => ({pose: b.pose, size: point(xyz(b.half_extents).map(h => 2 * h)),
                                   color: hex(kTheme.mover, 0.6)}));
  return scene([entity('moving boxes', m.header.stamp, {cubes})]);
}

// Where they are thought to go, and the boxes that hold them then.
function predicted(m) {
  const lines = [];
  for (const box of m.obstacles.map(Goshawk.predictedBox).filter(b => b.track.length)) {
    const shapes = Goshawk.predictedShapes(box);
    lines.push(line(shapes.line, 0.04, hex(kTheme.mover)));
    for (const {p, half} of shapes.boxes) {
      lines.push(line(Goshawk.boxEdges(p, box.q, half), 1, hex(kTheme.mover, 0.5), {type: 2, scale_invariant: true}));
    }
  }
  return scene([entity('predictions', m.header.stamp, {lines})]);
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
                entity('trajectory', m.header.stamp, {lines: [line(points, 0.06, rgba([1, 1, 1]), {colors})]}),
                entity('stop part', m.header.stamp, stopParts(m, trajectory))]);
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
                 'goshawk_msgs/msg/VoxelGridUpdate': updated, 'goshawk_msgs/msg/MovingBoxes': movers,
                 'goshawk_msgs/msg/PredictedObstacles': predicted,
                 'goshawk_msgs/msg/Path': path, 'goshawk_msgs/msg/CommittedTrajectory': committed,
                 'nav_msgs/msg/Odometry': flown};
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
