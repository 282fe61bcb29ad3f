// The picture: map, paths, corridor, trajectory, flown track, vehicle. Frame map, z up, [m].
'use strict';
const G3 = THREE;

Goshawk.themes = {
  dark: {sky: 0x0d1320, ground: 0x141c2d, grid: 0x3a4a68, low: 0x46536e, high: 0xa9b6cf, ink: 0.45,
         ghost: 0x8fa3c8, grown: 0x5b7cc0, raw: 0xc9a4ff, pruned: 0xff9f43, corridor: 0x39c5e8,
         flown: 0xffffff, body: 0xe9eef8, accent: 0xff4d5e, goal: 0x5df2a0},
  light: {sky: 0xf3f5f9, ground: 0xe7ebf2, grid: 0xb9c3d4, low: 0xaab5c8, high: 0xf4f6fa, ink: 0.5,
          ghost: 0x5f7196, grown: 0x4c6fb8, raw: 0x7c4dbc, pruned: 0xd96b00, corridor: 0x0a86b0,
          flown: 0x14181f, body: 0x20283a, accent: 0xd3122b, goal: 0x0b8a4b},
};

// Google's Turbo without its darkest ends: slow is blue, fast is red.
Goshawk.speedColor = function(ratio) {
  const stops = [[0.27, 0.42, 0.95], [0.13, 0.78, 0.87], [0.35, 0.95, 0.45], [0.95, 0.88, 0.25],
                 [0.98, 0.52, 0.16], [0.88, 0.16, 0.12]];
  const s = Math.max(0, Math.min(1, ratio)) * (stops.length - 1);
  const k = Math.min(stops.length - 2, Math.floor(s));
  return V3.mix(stops[k], stops[k + 1], s - k);
};

const kVoxelVertex = `
attribute vec3 cell; attribute float face; attribute vec4 ao;
uniform vec3 origin; uniform float edge; uniform float inset;
varying vec2 q; varying vec4 open; varying vec3 normalMap; varying float height; varying float far;
void main() {
  float axis = floor(face / 2.0 + 0.01);
  float way = mod(face, 2.0) < 0.5 ? 1.0 : 0.0;
  vec3 n = axis < 0.5 ? vec3(1, 0, 0) : axis < 1.5 ? vec3(0, 1, 0) : vec3(0, 0, 1);
  vec3 u = n.zxy; vec3 v = n.yzx;
  vec3 p = origin + edge * (cell + n * way + u * position.x + v * position.y);
  q = position.xy; open = ao; normalMap = n * (2.0 * way - 1.0); height = p.z;
  vec4 eye = modelViewMatrix * vec4(p, 1.0);
  far = -eye.z;
  gl_Position = projectionMatrix * eye;
}`;

// Soft sky light, one sun, darker nooks, and thin voxel borders that vanish in the distance.
const kVoxelFragment = `
uniform vec3 low; uniform vec3 high; uniform vec3 sky; uniform float ink; uniform float opacity;
uniform vec2 span; uniform vec2 haze;
varying vec2 q; varying vec4 open; varying vec3 normalMap; varying float height; varying float far;
void main() {
  float rise = clamp((height - span.x) / max(span.y - span.x, 0.1), 0.0, 1.0);
  vec3 color = mix(low, high, rise);
  float light = 0.60 + 0.16 * normalMap.z + 0.26 * max(0.0, dot(normalMap, normalize(vec3(-0.5, -0.35, 0.8))))
              + 0.07 * normalMap.x;
  float nook = mix(mix(open.x, open.y, q.x), mix(open.z, open.w, q.x), q.y) / 3.0;
  light *= 0.55 + 0.45 * nook;
  vec2 width = fwidth(q);
  vec2 border = smoothstep(vec2(0.0), width * 1.2 + 0.015, min(q, 1.0 - q));
  float line = (1.0 - min(border.x, border.y)) * ink * clamp(1.0 - 2.2 * max(width.x, width.y), 0.0, 1.0);
  color *= light * (1.0 - 0.5 * line);
  color = mix(color, sky, 0.75 * smoothstep(haze.x, haze.y, far));
  gl_FragColor = vec4(color, opacity);
}`;

const kGroundFragment = `
uniform vec3 ground; uniform vec3 lines; uniform vec3 sky; uniform vec3 middle; uniform float radius;
varying vec3 at;
void main() {
  vec2 width = fwidth(at.xy);
  vec2 d = abs(fract(at.xy - 0.5) - 0.5) / width;
  float one = (1.0 - clamp(min(d.x, d.y), 0.0, 1.0)) * clamp(1.0 - 3.0 * max(width.x, width.y), 0.0, 1.0);
  vec2 d5 = abs(fract(at.xy / 5.0 - 0.5) - 0.5) / width * 5.0;
  float five = 1.0 - clamp(min(d5.x, d5.y), 0.0, 1.0);
  float fade = 1.0 - smoothstep(0.35, 1.0, distance(at, middle) / radius);
  vec3 color = mix(ground, lines, max(0.5 * one, 0.9 * five));
  gl_FragColor = vec4(mix(sky, color, fade), 1.0);
}`;

Goshawk.View = class {
  constructor(canvas) {
    this.canvas = canvas;
    this.renderer = new G3.WebGLRenderer({canvas, antialias: true});
    this.renderer.setPixelRatio(Math.min(window.devicePixelRatio || 1, 2));
    this.scene = new G3.Scene();
    this.camera = new G3.PerspectiveCamera(42, 1, 0.05, 5000);
    this.camera.up.set(0, 0, 1);
    this.controls = new G3.OrbitControls(this.camera, canvas);
    this.controls.enableDamping = true;
    this.controls.dampingFactor = 0.12;
    this.controls.maxPolarAngle = 0.495 * Math.PI;
    this.layers = {};
    for (const name of ['obstacles', 'above', 'grown', 'raw', 'pruned', 'corridor', 'trajectory',
                        'flown', 'vehicle', 'goals', 'ground']) {
      this.layers[name] = new G3.Group();
      this.scene.add(this.layers[name]);
    }
    this.layers.grown.visible = this.layers.raw.visible = false;
    this.maps = {};
    this.lineMaterials = new Set();
    this.cut = Infinity;
    this.speedScale = 2;
    this.theme = Goshawk.themes.dark;
    this.redraw = true;
    this.controls.addEventListener('change', () => { this.redraw = true; });
    this.makeLights();
    this.makeVehicle();
    this.resize();
  }

  makeLights() {
    this.scene.add(new G3.HemisphereLight(0xffffff, 0x445066, 0.85));
    const sun = new G3.DirectionalLight(0xffffff, 0.55);
    sun.position.set(-5, -3.5, 8);
    this.scene.add(sun);
  }

  resize() {
    const w = this.canvas.clientWidth || 1, h = this.canvas.clientHeight || 1;
    this.renderer.setSize(w, h, false);
    this.camera.aspect = w / h;
    this.shiftFromPanel();
    for (const m of this.lineMaterials) m.resolution.set(w, h);
    this.redraw = true;
  }

  setTheme(name) {
    this.theme = Goshawk.themes[name];
    this.remake();
  }

  // Everything is made anew from what it shows: simple, and fast enough for a click.
  remake() {
    this.scene.background = new G3.Color(this.theme.sky);
    this.drawMaps();
    if (this.legs) this.setLegs(this.legs);
    if (this.track) this.setFlown(this.track);
    if (this.goalPoints) this.setGoals(this.goalPoints);
    this.makeVehicle();
    this.redraw = true;
  }

  clear(name) {
    const group = this.layers[name];
    group.traverse(o => {
      if (o.geometry) o.geometry.dispose();
      if (o.material) { this.lineMaterials.delete(o.material); o.material.dispose(); }
    });
    while (group.children.length) group.remove(group.children[0]);
    return group;
  }

  // kind: 'obstacles' or 'grown'
  setMap(kind, voxels) {
    this.maps[kind] = voxels;
    this.drawMaps();
  }

  setCut(z) {
    this.cut = z;
    this.drawMaps();
  }

  bounds() {
    const box = new G3.Box3();
    for (const map of Object.values(this.maps)) {
      box.expandByPoint(new G3.Vector3(...map.origin));
      box.expandByPoint(new G3.Vector3(map.upper(0), map.upper(1), map.upper(2)));
    }
    for (const leg of this.legs || []) {
      for (const p of leg.waypoints || []) box.expandByPoint(new G3.Vector3(...p));
    }
    for (const s of this.track || []) box.expandByPoint(new G3.Vector3(...s.p));
    if (box.isEmpty()) box.set(new G3.Vector3(-5, -5, 0), new G3.Vector3(5, 5, 3));
    return box;
  }

  drawMaps() {
    const {obstacles, grown} = this.maps;
    for (const name of ['obstacles', 'above', 'grown', 'ground']) this.clear(name);
    const radius = this.bounds().getBoundingSphere(new G3.Sphere()).radius;
    this.haze = [2.2 * radius, 6.5 * radius];
    const t = this.theme;
    const shown = name => this.layers[name].visible;
    if (obstacles) {
      const top = obstacles.layersBelow(this.cut);
      if (shown('obstacles')) this.addVoxels('obstacles', obstacles, 0, top, t.low, t.high, 1);
      if (shown('above')) this.addVoxels('above', obstacles, top, obstacles.size[2], t.ghost, t.ghost, 0.05);
    }
    if (grown && shown('grown')) {
      const solid = obstacles ? 0.16 : 1;
      const colors = obstacles ? [t.grown, t.grown] : [t.low, t.high];
      this.addVoxels('grown', grown, 0, grown.layersBelow(this.cut), ...colors, solid);
    }
    this.addGround(radius);
    this.redraw = true;
  }

  addVoxels(layer, voxels, z0, z1, low, high, opacity) {
    const faces = Goshawk.voxelFaces(voxels, z0, z1);
    if (!faces.face.length) return;
    const geometry = new G3.InstancedBufferGeometry();
    geometry.setAttribute('position', new G3.Float32BufferAttribute(
        [0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0], 3));
    geometry.setIndex([0, 1, 2, 0, 2, 3]);
    geometry.setAttribute('cell', new G3.InstancedBufferAttribute(faces.cell, 3));
    geometry.setAttribute('face', new G3.InstancedBufferAttribute(faces.face, 1));
    geometry.setAttribute('ao', new G3.InstancedBufferAttribute(faces.ao, 4));
    geometry.maxInstancedCount = faces.face.length;
    const material = new G3.ShaderMaterial({
      uniforms: {
        origin: {value: new G3.Vector3(...voxels.origin)}, edge: {value: voxels.resolution},
        low: {value: new G3.Color(low)}, high: {value: new G3.Color(high)},
        sky: {value: new G3.Color(this.theme.sky)}, ink: {value: this.theme.ink},
        opacity: {value: opacity}, haze: {value: new G3.Vector2(...this.haze)},
        span: {value: new G3.Vector2(voxels.origin[2], Math.min(voxels.upper(2), this.cut + 0.5))},
      },
      vertexShader: kVoxelVertex, fragmentShader: kVoxelFragment, side: G3.DoubleSide,
      transparent: opacity < 1, depthWrite: opacity === 1,
    });
    material.extensions.derivatives = true;
    const mesh = new G3.Mesh(geometry, material);
    mesh.frustumCulled = false;
    mesh.renderOrder = opacity < 1 ? 5 : 0;
    this.layers[layer].add(mesh);
  }

  addGround(radius) {
    const box = this.bounds(), middle = box.getCenter(new G3.Vector3());
    middle.z = box.min.z - 0.02;
    const r = 2.6 * radius;
    const material = new G3.ShaderMaterial({
      uniforms: {ground: {value: new G3.Color(this.theme.ground)}, radius: {value: r},
                 lines: {value: new G3.Color(this.theme.grid)}, middle: {value: middle},
                 sky: {value: new G3.Color(this.theme.sky)}},
      vertexShader: `varying vec3 at;
        void main() { at = (modelMatrix * vec4(position, 1.0)).xyz;
                      gl_Position = projectionMatrix * viewMatrix * vec4(at, 1.0); }`,
      fragmentShader: kGroundFragment, side: G3.DoubleSide,
    });
    material.extensions.derivatives = true;
    const mesh = new G3.Mesh(new G3.CircleBufferGeometry(r, 96), material);
    mesh.position.copy(middle);
    this.layers.ground.add(mesh);
  }

  // @param width [pixel]; colors: one [r, g, b] a point, or nothing
  line(layer, points, {color = 0xffffff, width = 2, opacity = 1, colors = null, order = 2, hidden = false}) {
    if (points.length < 2) return null;
    const geometry = new G3.LineGeometry();
    geometry.setPositions(points.flat());
    if (colors) geometry.setColors(colors.flat());
    const material = new G3.LineMaterial({
      color: colors ? 0xffffff : color, linewidth: width, transparent: opacity < 1,
      vertexColors: colors ? G3.VertexColors : G3.NoColors});
    material.opacity = opacity;
    material.uniforms.opacity.value = opacity;
    material.depthTest = !hidden;  // what obstacles hide shines through them, faintly
    material.depthWrite = !hidden;
    material.polygonOffset = true;  // the later one of two lines in one place is seen
    material.polygonOffsetFactor = material.polygonOffsetUnits = -2 * order;
    material.resolution.set(this.canvas.clientWidth || 1, this.canvas.clientHeight || 1);
    this.lineMaterials.add(material);
    const line = new G3.Line2(geometry, material);
    line.frustumCulled = false;
    line.renderOrder = order;
    this.layers[layer].add(line);
    return line;
  }

  // leg: {raw, waypoints, corridor: [{A, b}], trajectory: Goshawk.Trajectory or null}
  setLegs(legs) {
    this.legs = legs;
    for (const name of ['raw', 'pruned', 'corridor', 'trajectory']) this.clear(name);
    for (const leg of legs) {
      this.line('raw', leg.raw || [], {color: this.theme.raw, width: 2});
      this.line('pruned', leg.waypoints || [], {color: this.theme.pruned, width: 2});
      (leg.waypoints || []).forEach(p => this.dot('pruned', p, 0.045, this.theme.pruned));
      (leg.corridor || []).forEach(p => this.addPolytope(p));
      if (leg.trajectory) this.addTrajectory(leg.trajectory);
    }
    this.redraw = true;
  }

  dot(layer, p, radius, color) {
    const mesh = new G3.Mesh(new G3.SphereBufferGeometry(radius, 20, 14),
                             new G3.MeshLambertMaterial({color}));
    mesh.position.set(...p);
    this.layers[layer].add(mesh);
    return mesh;
  }

  addPolytope({A, b}) {
    const polygons = Goshawk.polytopeFaces(A, b);
    const corners = [], edges = [];
    for (const polygon of polygons) {
      for (let k = 1; k + 1 < polygon.length; ++k) corners.push(polygon[0], polygon[k], polygon[k + 1]);
      polygon.forEach((p, k) => edges.push(p, polygon[(k + 1) % polygon.length]));
    }
    const geometry = new G3.BufferGeometry();
    geometry.setAttribute('position', new G3.Float32BufferAttribute(corners.flat(), 3));
    const mesh = new G3.Mesh(geometry, new G3.MeshBasicMaterial({
      color: this.theme.corridor, transparent: true, opacity: 0.045, side: G3.DoubleSide,
      depthWrite: false}));
    mesh.renderOrder = 3;
    const wire = new G3.BufferGeometry();
    wire.setAttribute('position', new G3.Float32BufferAttribute(edges.flat(), 3));
    const lines = new G3.LineSegments(wire, new G3.LineBasicMaterial({
      color: this.theme.corridor, transparent: true, opacity: 0.42, depthWrite: false}));
    lines.renderOrder = 4;
    this.layers.corridor.add(mesh, lines);
  }

  addTrajectory(trajectory) {
    const steps = Math.max(2, Math.ceil(trajectory.duration / 0.04));
    const points = [], colors = [];
    for (let k = 0; k <= steps; ++k) {
      const s = trajectory.sample(trajectory.duration * k / steps);
      points.push(s.position);
      colors.push(Goshawk.speedColor(V3.norm(s.velocity) / this.speedScale));
    }
    this.line('trajectory', points, {width: 5, colors});
    this.line('trajectory', points, {width: 3, colors, opacity: 0.22, hidden: true, order: 6});
  }

  // track: [{t, p, v, q}]
  setFlown(track) {
    this.track = track;
    this.clear('flown');
    this.line('flown', track.map(s => s.p), {color: this.theme.flown, width: 1.6, order: 3});
    this.redraw = true;
  }

  setGoals(points) {
    this.goalPoints = points;
    this.clear('goals');
    const floor = this.bounds().min.z;
    points.forEach((p, k) => {
      const color = k === 0 ? this.theme.body : this.theme.goal;
      this.dot('goals', p, 0.09, color);
      this.line('goals', [p, [p[0], p[1], floor]], {color, width: 1.2, opacity: 0.6});
      const ring = new G3.Mesh(new G3.RingBufferGeometry(0.2, 0.25, 48),
                               new G3.MeshBasicMaterial({color, side: G3.DoubleSide}));
      ring.position.set(p[0], p[1], floor + 0.01);
      this.layers.goals.add(ring);
    });
    this.redraw = true;
  }

  // An X of arms with rotors that reach to the body's radius, true to scale.
  makeVehicle(radius = this.bodyRadius || 0.15) {
    this.bodyRadius = radius;
    const old = this.layers.vehicle.children[0];
    const group = this.clear('vehicle');
    this.body = new G3.Group();
    const {body, accent} = this.theme;
    const shell = new G3.MeshLambertMaterial({color: body});
    const part = (geometry, material, x, y, z) => {
      const mesh = new G3.Mesh(geometry, material);
      mesh.position.set(x, y, z);
      this.body.add(mesh);
      return mesh;
    };
    const r = radius, hull = part(new G3.SphereBufferGeometry(0.3 * r, 24, 16), shell, 0, 0, 0);
    hull.scale.set(1.35, 1, 0.55);
    part(new G3.ConeBufferGeometry(0.14 * r, 0.4 * r, 20), new G3.MeshLambertMaterial({color: accent}),
         0.52 * r, 0, 0).rotation.z = -Math.PI / 2;
    for (const [x, y] of [[1, 1], [1, -1], [-1, 1], [-1, -1]]) {
      const d = 0.43 * r;
      const arm = part(new G3.BoxBufferGeometry(0.62 * r, 0.07 * r, 0.05 * r), shell, x * d * 0.55, y * d * 0.55, 0);
      arm.rotation.z = Math.atan2(y, x);
      const color = x > 0 ? accent : body;
      const disc = part(new G3.CylinderBufferGeometry(0.36 * r, 0.36 * r, 0.015 * r, 36),
                        new G3.MeshBasicMaterial({color, transparent: true, opacity: 0.4}), x * d, y * d, 0.11 * r);
      disc.rotation.x = Math.PI / 2;
      const rim = part(new G3.TorusBufferGeometry(0.36 * r, 0.025 * r, 8, 40),
                       new G3.MeshLambertMaterial({color}), x * d, y * d, 0.11 * r);
      rim.rotation.set(0, 0, 0);
    }
    // A ring around the vehicle that nothing hides.
    const halo = document.createElement('canvas');
    halo.width = halo.height = 64;
    const g = halo.getContext('2d');
    g.strokeStyle = '#fff';
    g.lineWidth = 4;
    g.beginPath(); g.arc(32, 32, 28, 0, 7); g.stroke();
    const sprite = new G3.Sprite(new G3.SpriteMaterial({map: new G3.CanvasTexture(halo), color: accent,
      transparent: true, opacity: 0.85, depthTest: false}));
    sprite.scale.setScalar(3.4 * r);
    sprite.renderOrder = 7;
    this.body.add(sprite);
    if (old) { this.body.position.copy(old.position); this.body.quaternion.copy(old.quaternion); }
    group.add(this.body);
  }

  setVehicle(p, q) {
    if (this.follow) {
      const step = new G3.Vector3(...p).sub(this.body.position);
      this.camera.position.add(step);
      this.controls.target.add(step);
    }
    this.body.position.set(...p);
    this.body.quaternion.set(q[1], q[2], q[3], q[0]);
    this.redraw = true;
  }

  // Looks at the points from above, from the side where the fewest obstacles stand in the way.
  frame(points) {
    const box = new G3.Box3();
    points.forEach(p => box.expandByPoint(new G3.Vector3(...p)));
    if (box.isEmpty()) box.copy(this.bounds());
    const size = box.getSize(new G3.Vector3());
    const target = box.getCenter(new G3.Vector3());
    const reach = Math.max(size.length(), 4 * this.bodyRadius + 2);
    // Narrow windows need more distance.
    const distance = 1.3 * reach / Math.min(1, 0.75 * this.camera.aspect);
    const across = Math.atan2(size.x, size.y);
    let best = null;
    for (let k = 0; k < 24; ++k) {
      for (const elevation of [0.6, 0.8, 1.0]) {
        const azimuth = 2 * Math.PI * k / 24;
        const way = [Math.cos(elevation) * Math.cos(azimuth), Math.cos(elevation) * Math.sin(azimuth),
                     Math.sin(elevation)];
        // A long flight is best seen across; a low view shows more of the obstacles.
        const along = Math.abs(Math.sin(azimuth - across)) * Math.abs(size.x - size.y) / (size.length() + 1e-9);
        const cost = this.hiddenShare(points, way) + 0.25 * along + 0.12 * (elevation - 0.6);
        if (!best || cost < best.cost) best = {cost, way};
      }
    }
    this.controls.target.copy(target);
    this.camera.position.copy(target).add(new G3.Vector3(...best.way).multiplyScalar(distance));
    this.shiftFromPanel();
    this.controls.update();
    this.redraw = true;
  }

  // The middle of the picture is the middle of what the panel leaves free.
  shiftFromPanel() {
    const w = this.canvas.clientWidth || 1, h = this.canvas.clientHeight || 1;
    const shift = w > 900 ? 120 : 0;
    this.camera.setViewOffset(w, h, -shift, 0, w, h);
  }

  // The highest cut from which most of the points are seen from above: below ceilings, above trees.
  bestCut(points) {
    const map = this.maps.obstacles || this.maps.grown;
    const heights = points.map(p => p[2]).sort((a, b) => a - b);
    const highest = Math.min(map.upper(2), (heights.length ? heights[heights.length - 1] : map.upper(2)) + 0.3);
    const lowest = heights.length ? heights[heights.length >> 1] : highest;
    for (this.cut = highest; this.cut > lowest; this.cut -= map.resolution) {
      if (this.hiddenShare(points, [0, 0, 1]) < 0.1) return this.cut;
    }
    return points.length ? lowest : highest;
  }

  // The share of the points that obstacles below the cut hide from far away.
  hiddenShare(points, way) {
    const map = this.maps.obstacles || this.maps.grown;
    if (!map || !points.length) return 0;
    const top = map.layersBelow(this.cut), [nx, ny] = map.size;
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
  }

  // Where the pointer meets the plane of a height. @return [x, y, z], or nothing
  pick(event, height) {
    const r = this.canvas.getBoundingClientRect();
    const ray = new G3.Raycaster();
    ray.setFromCamera({x: 2 * (event.clientX - r.left) / r.width - 1,
                       y: 1 - 2 * (event.clientY - r.top) / r.height}, this.camera);
    const hit = ray.ray.intersectPlane(new G3.Plane(new G3.Vector3(0, 0, 1), -height), new G3.Vector3());
    return hit && [hit.x, hit.y, hit.z];
  }

  // Where a point of the map is on the page [pixel].
  project(p) {
    const r = this.canvas.getBoundingClientRect();
    const v = new G3.Vector3(...p).project(this.camera);
    return [r.left + (v.x + 1) / 2 * r.width, r.top + (1 - v.y) / 2 * r.height];
  }

  render() {
    this.controls.update();
    if (!this.redraw) return;
    this.redraw = false;
    this.renderer.render(this.scene, this.camera);
  }

  // For tests: a drawn frame as numbers. @return {width, height, colors: how many different ones}
  pixels() {
    this.renderer.render(this.scene, this.camera);
    const gl = this.renderer.getContext();
    const w = gl.drawingBufferWidth, h = gl.drawingBufferHeight;
    const bytes = new Uint8Array(4 * w * h);
    gl.readPixels(0, 0, w, h, gl.RGBA, gl.UNSIGNED_BYTE, bytes);
    const colors = new Set();
    for (let k = 0; k < bytes.length; k += 4) {
      colors.add((bytes[k] << 16) | (bytes[k + 1] << 8) | bytes[k + 2]);
    }
    return {width: w, height: h, colors: colors.size};
  }
};
