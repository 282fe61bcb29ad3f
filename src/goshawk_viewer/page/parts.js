// What moves or is flown, as lines and boxes: the parts of a commit, moving boxes, what changed, the cloud,
// the window of the map. Frame map, [m].
'use strict';

// Where a commit parts. @param leg {trajectory: what is flown, stopAfter [s] or 0, nominal: Trajectory or null}
// @return {at, rest: places; nominal, stop: points along them}, or null if it has no stop part
Goshawk.commitParts = leg => {
  if (!(leg.stopAfter > 0) || !leg.nominal) return null;
  const along = (trajectory, from) => {
    const steps = Math.max(2, Math.ceil((trajectory.duration - from) / 0.05)), points = [];
    for (let k = 0; k <= steps; ++k) {
      points.push(trajectory.sample(from + (trajectory.duration - from) * k / steps).position);
    }
    return points;
  };
  const stop = along(leg.trajectory, leg.stopAfter);
  return {at: stop[0], rest: stop[stop.length - 1], stop, nominal: along(leg.nominal, leg.stopAfter)};
};

// The corners of a box, its edges as pairs of places. @param q [w, x, y, z] box to map
Goshawk.boxEdges = (p, q, half) => {
  const turned = v => {
    const u = q.slice(1), twice = V3.cross(u, v).map(c => 2 * c);
    return V3.add(p, V3.add(V3.add(v, twice, q[0]), V3.cross(u, twice)));
  };
  const corner = k => turned(half.map((h, i) => (k >> i & 1 ? h : -h)));
  const edges = [];
  for (let k = 0; k < 8; ++k) {
    for (let i = 0; i < 3; ++i) if (!(k >> i & 1)) edges.push(corner(k), corner(k | 1 << i));
  }
  return edges;
};

// Where a predicted box will be: its track, and at a few moments the box that holds it, with the bound of the
// error. @param box {q, half, track: [{duration, points}], error, error_rate, valid_until}
Goshawk.predictedShapes = box => {
  const track = new Goshawk.Trajectory(box.track);
  const until = Math.max(0, Math.min(box.valid_until, track.duration));
  const at = share => {
    const t = share * until;
    return {t, p: track.sample(t).position, half: box.half.map(h => h + box.error + box.error_rate * t)};
  };
  return {line: Array.from({length: 21}, (_, k) => at(k / 20).p), boxes: [0, 0.5, 1].map(at)};
};

const kChangeColors = {blocked: [1, 0.45, 0.1], freed: [0.35, 0.95, 0.6], learnt: [0.35, 0.62, 1]};

Goshawk.Parts = class {
  constructor(view) { this.view = view; }

  segments(layer, places, color, opacity = 1, order = 5) {
    if (!places.length) return;
    const geometry = new G3.BufferGeometry();
    geometry.setAttribute('position', new G3.Float32BufferAttribute(places.flat(), 3));
    const lines = new G3.LineSegments(geometry, new G3.LineBasicMaterial(
        {color, transparent: true, opacity, depthWrite: false}));
    lines.renderOrder = order;
    lines.frustumCulled = false;
    this.view.layers[layer].add(lines);
  }

  // @param size [m], or [pixel] if `fixed`; colors: three numbers a place, or null
  points(layer, places, {size, fixed, color = 0xffffff, colors = null, opacity = 1}) {
    if (!places.length) return;
    const geometry = new G3.BufferGeometry();
    geometry.setAttribute('position', new G3.BufferAttribute(
        places instanceof Float32Array ? places : new Float32Array(places), 3));
    if (colors) geometry.setAttribute('color', new G3.Float32BufferAttribute(colors, 3));
    const cloud = new G3.Points(geometry, new G3.PointsMaterial({
      size, sizeAttenuation: !fixed, color: colors ? 0xffffff : color, transparent: opacity < 1, opacity,
      vertexColors: colors ? G3.VertexColors : G3.NoColors, depthWrite: opacity >= 1}));
    cloud.frustumCulled = false;
    cloud.renderOrder = 5;
    this.view.layers[layer].add(cloud);
  }

  // Both parts of the newest commit.
  setCommit(leg) {
    const {view} = this, {theme} = view;
    for (const name of ['nominal', 'stop']) view.clear(name);
    this.commit = leg;
    const parts = leg && Goshawk.commitParts(leg);
    view.redraw = true;
    if (!parts) return;
    for (let k = 0; k + 1 < parts.nominal.length; k += 2) {  // dashed
      view.line('nominal', parts.nominal.slice(k, k + 2), {color: theme.nominal, width: 2, hidden: true, order: 6});
    }
    view.line('stop', parts.stop, {color: theme.stop, width: 3, hidden: true, order: 6});
    view.dot('stop', parts.at, 0.06, theme.stop);
    view.dot('stop', parts.rest, 0.09, theme.stop);
  }

  // @param boxes [{p, q, half}] as they are now; predictions [box of Goshawk.predictedShapes]
  setMovers(boxes, predictions) {
    const {view} = this, {theme} = view;
    view.clear('movers');
    this.movers = [boxes, predictions];
    this.segments('movers', boxes.flatMap(b => Goshawk.boxEdges(b.p, b.q, b.half)), theme.mover);
    for (const b of boxes) {
      const mesh = new G3.Mesh(new G3.BoxBufferGeometry(...b.half.map(h => 2 * h)), new G3.MeshLambertMaterial(
          {color: theme.mover, transparent: true, opacity: 0.45}));
      mesh.position.set(...b.p);
      mesh.quaternion.set(b.q[1], b.q[2], b.q[3], b.q[0]);
      view.layers.movers.add(mesh);
    }
    for (const b of predictions) {
      const shapes = Goshawk.predictedShapes(b);
      view.line('movers', shapes.line, {color: theme.mover, width: 2});
      for (const {p, half} of shapes.boxes) {
        this.segments('movers', Goshawk.boxEdges(p, b.q, half), theme.mover, 0.35);
      }
    }
    view.redraw = true;
  }

  // What changed last. @param places of Goshawk.MapChanges
  setChanges(voxels, places) {
    this.view.clear('changed');
    const colors = [], at = [];
    for (const [cell, kind] of places) {
      colors.push(...kChangeColors[kind]);
      at.push(...cell.map((c, i) => voxels.origin[i] + (c + 0.5) * voxels.resolution));
    }
    this.points('changed', at, {size: 0.45 * voxels.resolution, colors, opacity: 0.5});
    this.view.redraw = true;
  }

  setCloud(points) {
    this.view.clear('cloud');
    this.cloud = points;
    // Thin: the vehicle, its plan and obstacles lie behind it.
    this.points('cloud', points, {size: 1, fixed: true, color: this.view.theme.cloud, opacity: 0.25});
    this.view.redraw = true;
  }

  // The box of the world that the map holds. @param voxels or null
  setWindow(voxels) {
    this.view.clear('window');
    this.window = voxels;
    this.view.redraw = true;
    if (!voxels) return;
    const half = voxels.size.map(n => n * voxels.resolution / 2);
    this.segments('window', Goshawk.boxEdges(voxels.origin.map((o, i) => o + half[i]), [1, 0, 0, 0], half),
                  this.view.theme.ghost, 0.6);
  }

  // Why it failed. @param data {voxel: {center, size} or null, goal or null, path: places}
  setRefused({voxel, goal, path}) {
    const {view} = this, color = view.theme.accent;
    view.clear('refused');
    this.refused = {voxel, goal, path};
    view.redraw = true;
    view.line('refused', path, {color, width: 3, hidden: true, order: 6});
    if (goal) view.dot('refused', goal, 0.11, color);
    if (!voxel) return;
    const half = Array(3).fill(0.505 * voxel.size);
    const mesh = new G3.Mesh(new G3.BoxBufferGeometry(...half.map(h => 2 * h)),
                             new G3.MeshBasicMaterial({color, transparent: true, opacity: 0.75, depthTest: false}));
    mesh.position.set(...voxel.center);
    mesh.renderOrder = 6;
    view.layers.refused.add(mesh);
    if (goal) view.line('refused', [goal, voxel.center], {color, width: 1.5, hidden: true, order: 6});
  }

  // In the colours of another theme.
  remake() {
    if (this.commit) this.setCommit(this.commit);
    if (this.movers) this.setMovers(...this.movers);
    if (this.cloud) this.setCloud(this.cloud);
    if (this.window) this.setWindow(this.window);
    if (this.refused) this.setRefused(this.refused);
  }
};
