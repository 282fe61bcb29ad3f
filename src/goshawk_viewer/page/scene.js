// The picture: map, paths, corridor, trajectory, flown track, vehicle. Frame map, z up, [m].
'use strict';
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
    for (const name of ['obstacles', 'above', 'grown', 'unseen', 'changed', 'cloud', 'window', 'raw', 'pruned',
                        'corridor', 'trajectory', 'nominal', 'stop', 'flown', 'movers', 'vehicle', 'goals',
                        'refused', 'measure', 'aim', 'ground']) {
      this.layers[name] = new G3.Group();
      this.scene.add(this.layers[name]);
    }
    this.layers.grown.visible = this.layers.raw.visible = false;
    this.maps = {};  // obstacles, grown, known: as the vehicle's map has them; world: the true one
    this.mapLayers = new Goshawk.MapLayers(this);
    this.parts = new Goshawk.Parts(this);
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

  // Layers are rebuilt as a whole: simple, and fast enough for a click.
  remake() {
    this.scene.background = new G3.Color(this.theme.sky);
    this.drawMaps();
    if (this.legs) this.setLegs(this.legs, this.followed);
    this.parts.remake();
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
    this.mapLayers.draw();
    this.clear('ground');
    this.addGround(this.bounds().getBoundingSphere(new G3.Sphere()).radius);
    this.redraw = true;
  }

  addGround(radius) {
    const box = this.bounds(), middle = box.getCenter(new G3.Vector3());
    middle.z = box.min.z - 0.02;
    this.layers.ground.add(Goshawk.groundMesh(middle, 2.6 * radius, this.theme));
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
    material.polygonOffset = true;  // of two lines in one place, the later one is seen
    material.polygonOffsetFactor = material.polygonOffsetUnits = -2 * order;
    material.resolution.set(this.canvas.clientWidth || 1, this.canvas.clientHeight || 1);
    this.lineMaterials.add(material);
    const line = new G3.Line2(geometry, material);
    line.frustumCulled = false;
    line.renderOrder = order;
    this.layers[layer].add(line);
    return line;
  }

  // @param legs [{raw, waypoints, corridor: [{A, b}], trajectory: Goshawk.Trajectory or null}] that are drawn
  // whole; followed [{leg, until}]: the trajectories that are drawn, up to a time [s] since their starts
  setLegs(legs, followed = Goshawk.followedLegs(legs)) {
    this.legs = legs;
    this.followed = followed;
    for (const name of ['raw', 'pruned', 'corridor', 'trajectory']) this.clear(name);
    for (const leg of legs) {
      this.line('raw', leg.raw || [], {color: this.theme.raw, width: 2});
      this.line('pruned', leg.waypoints || [], {color: this.theme.pruned, width: 2});
      (leg.waypoints || []).forEach(p => this.dot('pruned', p, 0.045, this.theme.pruned));
      (leg.corridor || []).forEach(p => this.addPolytope(p));
    }
    for (const {leg, until} of followed) this.addTrajectory(leg.trajectory, until);
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

  addTrajectory(trajectory, until) {
    const steps = Math.max(2, Math.ceil(until / 0.04));
    const points = [], colors = [];
    for (let k = 0; k <= steps; ++k) {
      const s = trajectory.sample(until * k / steps);
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

  // Where the goal would be [m], with a line down to the floor; null: nowhere.
  setAim(p) {
    this.clear('aim');
    this.redraw = true;
    if (!p) return;
    const floor = this.bounds().min.z, color = this.theme.goal;
    this.dot('aim', p, 0.09, color);
    this.line('aim', [p, [p[0], p[1], floor]], {color, width: 2, hidden: true, order: 6});
  }

  makeVehicle(radius = this.bodyRadius || 0.15) {
    this.bodyRadius = radius;
    const old = this.body, group = this.clear('vehicle');
    this.body = Goshawk.vehicleModel(radius, this.theme);
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

  // Looks at the points from above, from the side with the fewest obstacles in between.
  frame(points) {
    const spots = points.length ? points : this.corners();
    const box = new G3.Box3().setFromPoints(spots.map(p => new G3.Vector3(...p)));
    const way = Goshawk.bestWay(points.length ? this.solid() : null, this.cut, spots, this.camera.aspect < 1);
    box.getCenter(this.controls.target);
    this.shiftFromPanel();
    Goshawk.fit(this.camera, this.controls.target, new G3.Vector3(...way),
                spots.map(p => new G3.Vector3(...p)), this.freePart(), 20 * this.bodyRadius + 1);
    this.controls.update();
    this.setHaze();
  }

  // Of the part of the map below the cut.
  corners() {
    const {min, max} = this.bounds();
    const top = Math.max(min.z, Math.min(max.z, this.cut));
    return [min.z, top].flatMap(z => [min.x, max.x].flatMap(x => [min.y, max.y].map(y => [x, y, z])));
  }

  // Haze begins behind what the camera looks at.
  setHaze() {
    const away = this.camera.position.distanceTo(this.controls.target);
    const radius = this.bounds().getBoundingSphere(new G3.Sphere()).radius;
    this.haze = [away + 1.2 * radius, away + 6 * radius];
    this.scene.traverse(o => {
      if (o.material && o.material.uniforms && o.material.uniforms.haze) {
        o.material.uniforms.haze.value.set(...this.haze);
      }
    });
    this.redraw = true;
  }

  // Turns around the target [rad], and zooms: a scale below 1 comes closer.
  turn(azimuth, elevation, scale) {
    const {camera, controls} = this;
    const [x, y, z] = camera.position.clone().sub(controls.target).toArray();
    const r = Math.hypot(x, y, z), level = Math.atan2(y, x) + azimuth;
    const height = Math.max(0.02, Math.min(1.55, Math.asin(z / r) + elevation));
    camera.position.set(Math.cos(height) * Math.cos(level), Math.cos(height) * Math.sin(level), Math.sin(height))
        .multiplyScalar(r * scale).add(controls.target);
    this.redraw = true;
  }

  // The map that hides things, or nothing.
  solid() { return this.maps.world || this.maps.obstacles || this.maps.grown; }

  // The width [pixel] that the panel takes; 0 if it lies over a narrow picture.
  panelWidth() {
    const panel = document.getElementById('panel');
    return window.innerWidth > 760 ? panel.getBoundingClientRect().right : 0;
  }

  // The width [pixel] that the cards on the right take.
  rightWidth() {
    const live = document.getElementById('live');
    return window.innerWidth > 760 && !live.hidden ? window.innerWidth - live.getBoundingClientRect().left : 0;
  }

  // Centres the picture in the part that the panel leaves free.
  shiftFromPanel() {
    const w = this.canvas.clientWidth || 1, h = this.canvas.clientHeight || 1;
    this.camera.setViewOffset(w, h, (this.rightWidth() - this.panelWidth()) / 2, 0, w, h);
  }

  // The part of the picture for the flight, right of the panel or below it; -1 to 1.
  freePart() {
    const w = this.canvas.clientWidth || 1, h = this.canvas.clientHeight || 1;
    const left = this.panelWidth(), right = this.rightWidth(), above = left ? 0 : 50;
    const side = Math.max(24, 0.13 * (w - left - right)), below = Math.max(24, 0.13 * h);
    return {left: 2 * (left + side) / w - 1, right: 1 - 2 * (right + side) / w,
            bottom: 2 * below / h - 1, top: 1 - 2 * (below + above) / h};
  }

  // @return the place [x, y, z] under the pointer at a height, or nothing
  pick(event, height) {
    const r = this.canvas.getBoundingClientRect();
    const ray = new G3.Raycaster();
    ray.setFromCamera({x: 2 * (event.clientX - r.left) / r.width - 1,
                       y: 1 - 2 * (event.clientY - r.top) / r.height}, this.camera);
    const hit = ray.ray.intersectPlane(new G3.Plane(new G3.Vector3(0, 0, 1), -height), new G3.Vector3());
    return hit && [hit.x, hit.y, hit.z];
  }

  // @return the place of the map under the pointer: an obstacle's, or one at the vehicle's height; or nothing
  touch(event) {
    const r = this.canvas.getBoundingClientRect(), ray = new G3.Raycaster(), map = this.maps.obstacles || this.maps.grown;
    ray.setFromCamera({x: 2 * (event.clientX - r.left) / r.width - 1, y: 1 - 2 * (event.clientY - r.top) / r.height},
                      this.camera);
    const {origin, direction} = ray.ray;
    const hit = map && Goshawk.castRay(map, origin.toArray(), direction.toArray(), map.layersBelow(this.cut));
    return hit || this.pick(event, this.body.position.z);
  }

  // Up to two places, and the line between them.
  setMeasure(places) {
    this.clear('measure');
    places.forEach(p => this.dot('measure', p, 0.06, this.theme.accent));
    this.line('measure', places, {color: this.theme.accent, width: 2.5, hidden: true, order: 6});
    this.redraw = true;
  }

  // The compass turns with the picture.
  turnCompass() {
    const away = this.controls.target.clone().sub(this.camera.position);
    const angle = Math.atan2(away.x, away.y) * 180 / Math.PI;  // of the view, from y to x
    document.getElementById('rose').setAttribute('transform', `rotate(${(-angle).toFixed(1)})`);
  }

  pictureUrl() {
    this.renderer.render(this.scene, this.camera);
    return this.canvas.toDataURL('image/png');
  }

  // @return where a point of the map is on the page [pixel]
  project(p) {
    const r = this.canvas.getBoundingClientRect();
    const v = new G3.Vector3(...p).project(this.camera);
    return [r.left + (v.x + 1) / 2 * r.width, r.top + (1 - v.y) / 2 * r.height];
  }

  render() {
    this.controls.update();
    if (!this.redraw) return;
    this.redraw = false;
    this.turnCompass();
    this.renderer.render(this.scene, this.camera);
  }

  // For tests: draws a frame. @return {width, height, colors: the number of different ones}
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
