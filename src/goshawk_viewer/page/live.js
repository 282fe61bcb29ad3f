// The live page: the same picture with data from the bridge; a click sends a goal.
'use strict';
const kPlotted = 20;     // [s] that the plots show
const kTracked = 12000;  // samples of the flown track that are kept
const kStages = ['map_server', 'path_search', 'corridor_builder', 'trajectory_optimizer', 'navigator',
                 'guard', 'mission', 'tracker', 'vehicle', 'flight_check', 'viewer'];

// Of OperatorCommand.
const kVerbs = {hold: 0, resume: 1, resumeMission: 4};
const kAskAgain_ms = 300;  // a command is sent again until a stage answers ...
const kAsked = 20;         // ... so often at the most
const kNear = 3;           // [m] obstacles farther away are not looked for

const seconds = stamp => stamp.sec + 1e-9 * stamp.nanosec;
const xyz = p => [p.x, p.y, p.z];

Goshawk.LivePage = class extends Goshawk.Page {
  constructor(data) {
    super();
    this.url = new URLSearchParams(location.search).get('ws') || data.url ||
        `ws://${location.hostname || 'localhost'}:8765`;
    document.title = 'Goshawk live';
    $('title').textContent = 'Live';
    $('live').hidden = $('send').hidden = false;
    $('save-csv').title = 'the flown track of the last minutes: t, x, y, z, vx, vy, vz';
    $('timeline').hidden = true;
    this.track = [];
    this.paths = new Map();
    this.reports = new Map();
    this.curves = {speed: [], acceleration: [], error: []};
    this.makePlots(null);
    this.state = {link: 'connecting', mode: '', text: ''};
    this.bindGoal();
    this.bindCommands();
    this.changes = new Goshawk.MapChanges();
    this.moving = {movers: [], predictions: []};
    if (this.view) this.showLayers({refused: false, unseen: false, changed: false, window: false, cloud: false,
                                    movers: false, nominal: false, stop: false});
    this.client = new Goshawk.FoxgloveClient(this.url, this.topics(), text => this.setLink(text));
    this.tell();
  }

  topics() {
    const of = {
      'map/voxels': ['VoxelGrid', m => this.onGrown(m)], 'map/voxels/updates': ['VoxelGridUpdate', m => this.onUpdate(m)],
      path: ['Path', m => this.onPath(m)], committed_trajectory: ['CommittedTrajectory', m => this.onTrajectory(m)],
      navigator_state: ['NavigatorState', m => this.onNavigator(m)], stage_report: ['StageReport', m => this.onReport(m)],
      vehicle_status: ['VehicleStatus', m => { this.battery = m.battery; }],
      mission_state: ['MissionState', m => { this.mission = m; }], operator_answer: ['OperatorAnswer', m => this.onAnswer(m)],
      movers: ['MovingBoxes', m => this.onMovers(m)], obstacles: ['PredictedObstacles', m => this.onPredictions(m)]};
    const ours = Object.entries(of).map(([name, [type, take]]) => [name, ['goshawk_msgs/msg/' + type, take]]);
    return {...Object.fromEntries(ours), octomap_binary: ['octomap_msgs/msg/Octomap', m => this.onMap(m)],
            odom: ['nav_msgs/msg/Odometry', m => this.onOdometry(m)],
            points: ['sensor_msgs/msg/PointCloud2', m => this.onCloud(m)],
            why: ['std_msgs/msg/String', m => { $('why').textContent = m.data; }]};
  }

  // What nobody looks at is not sent.
  onLayer(name, shown) {
    if (name === 'cloud') this.client.read('points', shown);
  }

  // A layer that has content from now on.
  found(name) {
    const label = $('layer-' + name).parentElement;
    if (!label.hidden) return;
    label.hidden = false;
    this.view.layers[name].visible = $('layer-' + name).checked;
  }

  framed() {
    const leg = this.leg ? this.leg.waypoints : [];
    return [...leg, ...this.track.map(s => s.p)];
  }

  setLink(text) {
    this.state.link = text;
    this.tell();
  }

  tell() {
    const linked = this.state.link === 'connected';
    $('badge').hidden = false;
    $('badge').textContent = linked ? this.state.mode || 'connected' : 'not connected';
    $('badge').className = linked && this.state.mode !== 'failed' ? '' : 'bad';
    this.hint(this.missing(linked));
    $('sentence').textContent = linked ? '' : this.state.link;
    $('live-state').textContent = this.state.text;
  }

  // What is still missing, and how to get it.
  missing(linked) {
    const {maps} = this.view || {maps: {grown: true}};
    if (maps.obstacles || maps.grown) return '';
    if (linked) return 'Connected, but no map has come yet. Is map_server running\nwith the same ROS_DOMAIN_ID as the bridge?';
    return `Waiting for a bridge at ${this.url}.\nStart one with: tools/goshawk launch flight_view`;
  }

  // A map without raw voxels comes as an OctoMap as well.
  onMap(m) {
    if (!this.view || this.view.maps.known) return;
    const voxels = Goshawk.octomapVoxels(m.data, m.resolution);
    if (voxels) this.showMap('obstacles', voxels);
  }

  onGrown(m) {
    this.mapStamp = seconds(m.header.stamp);
    if (!this.view) return;
    const old = this.view.maps.grown;
    if (old && old.version === m.version) return;  // the same again, for who comes late
    const read = words => Goshawk.Voxels.fromWords(xyz(m.origin), m.resolution, [m.size_x, m.size_y, m.size_z], words);
    const grown = read(m.grown);
    grown.version = m.version;
    grown.unknown = m.unknown_is_occupied ? 1 : 0;
    if (m.raw.length && m.known.length) {
      this.view.maps.known = read(m.known);
      this.showMap('obstacles', read(m.raw));
      for (const name of ['unseen', 'changed', 'window']) this.found(name);
    }
    this.showMap('grown', grown);
    if (this.view.maps.known) this.view.parts.setWindow(grown);
  }

  // Bricks that changed. An update that does not follow is dropped: the whole map comes soon after.
  onUpdate(m) {
    this.mapStamp = seconds(m.header.stamp);
    const {grown, known, obstacles} = this.view ? this.view.maps : {};
    if (!grown || grown.version !== m.from_version) return;
    const shift = [m.shift_word_x, m.shift_brick_y, m.shift_brick_z], seen = known && known.size.join() === grown.size.join();
    grown.moveWindow(shift, grown.unknown);
    if (seen) for (const voxels of [known, obstacles]) voxels.moveWindow(shift, 0);
    if (shift.some(c => c)) this.mapOld = true;  // all of it
    const changed = kind => (x, y, z, value) => this.changes.add(x, y, z, kind(value));
    for (const brick of m.bricks) {
      grown.setBrick(brick, brick.grown, (x, y, z) => this.changes.spread(x, y, z));
      if (!seen) continue;
      known.setBrick(brick, brick.known, changed(() => 'learnt'));
      obstacles.setBrick(brick, brick.raw, changed(value => (value ? 'blocked' : 'freed')));
    }
    grown.version = m.to_version;
    this.mapUpdates = (this.mapUpdates || 0) + 1;
  }

  // In the frame map, or in the vehicle's: others are not drawn. Read when it is drawn: newer ones may come first.
  onCloud(m) {
    const inBody = m.header.frame_id === 'base_link';
    if (!this.view || !this.pose || !(inBody || m.header.frame_id === 'map')) return;
    this.cloud = {message: m, pose: inBody ? this.pose : null};
  }

  drawCloud({message, pose}) {
    const places = Goshawk.cloudPlaces(message, pose);
    if (!places) return;
    this.found('cloud');
    this.view.parts.setCloud(places);
  }

  onMovers(m) {
    this.moving.movers = m.boxes.map(Goshawk.movingBox);
    this.showMovers();
  }

  onPredictions(m) {
    this.moving.predictions = m.obstacles.map(Goshawk.predictedBox).filter(b => b.track.length);
    this.showMovers();
  }

  showMovers() {
    if (!this.view) return;
    this.found('movers');
    this.view.parts.setMovers(this.moving.movers, this.moving.predictions);
  }

  showMap(kind, voxels) {
    const first = !this.view.maps.obstacles && !this.view.maps.grown;
    this.view.maps[kind] = voxels;
    if (first) {
      const last = this.track[this.track.length - 1];
      const height = last ? last.p[2] + 1.4 : voxels.upper(2);
      this.setCutRange(voxels.origin[2], voxels.upper(2), Math.min(voxels.upper(2), height));
      Object.assign($('goal-height'), {min: voxels.origin[2], max: voxels.upper(2)});
      $('goal-height').value = last ? last.p[2] : (voxels.origin[2] + voxels.upper(2)) / 2;
      this.showHeight();
    }
    if (first) {
      this.view.drawMaps();
      this.view.frame([]);
    }
    this.mapOld = !first;
    this.tell();
  }

  onPath(m) {
    this.paths.set(m.request.id, m);
    if (this.paths.size > 20) this.paths.delete(this.paths.keys().next().value);
  }

  onTrajectory(m) {
    const t = m.nominal;
    const path = this.paths.get(t.request.id);
    this.leg = {
      raw: path ? path.raw.map(xyz) : [], waypoints: path ? path.waypoints.map(xyz) : [],
      corridor: [...t.polytopes, ...m.stop_polytopes].map(p => ({A: p.normals, b: p.offsets})),
      trajectory: Goshawk.flown(m), start: seconds(m.start_time), stopAfter: m.stop_after,
      nominal: m.stop_after > 0 ? Goshawk.readPieces(t.pieces) : null};
    const {v_max, a_max} = t.request.limits;
    this.plots[0].limit = v_max;
    this.plots[1].limit = a_max;
    $('speed-top').textContent = v_max;
    this.setFacts([['planned', this.leg.trajectory.duration.toFixed(2) + ' s'],
                   ['polytopes', String(t.polytopes.length)], ['limits', `${v_max} m/s, ${a_max} m/s²`]]);
    if (!this.view) return;
    this.view.speedScale = v_max;
    this.view.setLegs([this.leg]);
    if (this.leg.nominal) for (const name of ['nominal', 'stop']) this.found(name);
    this.view.parts.setCommit(this.leg);
    this.view.setGoals([xyz(t.request.start.position), xyz(t.request.goal.position)]);
  }

  onOdometry(m) {
    const t = seconds(m.header.stamp), last = this.track[this.track.length - 1];
    const p = xyz(m.pose.pose.position), o = m.pose.pose.orientation;
    const speed = V3.norm(xyz(m.twist.twist.linear));
    this.pose = {p, q: [o.w, o.x, o.y, o.z]};
    this.speed = speed;
    if (last && t < last.t - 1) this.track = [];  // a new simulation
    if (last && t - last.t < 0.02) return;
    this.track.push({t, p, v: this.toMap(m.twist.twist.linear, o)});
    if (this.track.length > kTracked) this.track.splice(0, kTracked / 10);
    this.now = t;
    this.curves.speed.push([t, speed]);
    const n = this.track.length, before = this.track[Math.max(0, n - 6)], here = this.track[n - 1];
    if (t > before.t) {
      this.curves.acceleration.push(
          [(t + before.t) / 2, V3.norm(V3.add(here.v, before.v, -1)) / (t - before.t)]);
    }
    if (this.leg && t >= this.leg.start) {
      this.curves.error.push([t, V3.norm(V3.add(p, this.leg.trajectory.sample(t - this.leg.start).position, -1))]);
    }
    this.fresh = true;
  }

  // The twist is in the body's frame.
  toMap(v, o) {
    const q = [o.x, o.y, o.z], a = xyz(v);
    const twice = V3.cross(q, a).map(c => 2 * c);
    return V3.add(V3.add(a, twice, o.w), V3.cross(q, twice));
  }

  onNavigator(m) {
    this.state.mode = m.state;
    this.state.text = m.code === 'ok' ? '' : `${m.code}: ${m.message}`;
    this.tell();
  }

  // The state at one glance. Distances are to obstacles as they were measured.
  showGlance() {
    const obstacles = this.view && this.view.maps.obstacles;
    const rows = Goshawk.glance({
      mode: this.missionText() || this.state.mode, pose: this.pose, speed: this.speed, leg: this.leg, now: this.now,
      obstacle: obstacles ? Goshawk.nearestObstacle(obstacles, this.pose.p, kNear) : null,
      narrowest: obstacles && this.leg ? Goshawk.narrowest(obstacles, this.leg, this.now, 1) : null,
      mapAge: this.mapStamp === undefined ? null : this.now - this.mapStamp,
      battery: this.battery >= 0 ? this.battery : null});
    $('glance').replaceChildren(...rows.flatMap(([name, value]) => {
      const dt = document.createElement('dt'), dd = document.createElement('dd');
      dt.textContent = name;
      dd.textContent = value;
      return [dt, dd];
    }));
  }

  missionText() {
    const m = this.mission;
    if (!m || !['flying', 'waiting', 'paused'].includes(m.state)) return '';
    return `${this.state.mode}, mission ${m.state}: waypoint ${m.waypoint} of ${m.waypoints}`;
  }

  // Sent again until it is answered: the stage carries it out once.
  command(name) {
    clearInterval(this.asking);
    const id = Date.now(), verb = kVerbs[name];
    let asked = 0;
    const ask = () => {
      const linked = this.state.link === 'connected';
      if (linked) this.client.sendCommand(id, verb);
      this.state.text = linked ? `${name}: sent` : `${name}: not sent, no connection`;
      if (++asked > kAsked) {
        clearInterval(this.asking);
        this.state.text = `${name}: no answer`;
      }
      this.tell();
    };
    this.asked = id;
    this.asking = setInterval(ask, kAskAgain_ms);
    ask();
  }

  onAnswer(m) {
    if (m.client !== 'page' || m.id !== this.asked) return;
    clearInterval(this.asking);
    this.state.text = m.code === 'ok' ? m.message : `${m.code}: ${m.message}`;
    this.tell();
  }

  // Space holds, whatever has the focus, except while somebody types.
  bindCommands() {
    const waits = () => this.mission && ['paused', 'failed'].includes(this.mission.state);
    $('hold').addEventListener('click', () => this.command('hold'));
    $('resume').addEventListener('click', () => this.command(waits() ? 'resumeMission' : 'resume'));
    window.addEventListener('keydown', event => {
      if (event.key !== ' ' || event.target.type === 'text') return;
      event.preventDefault();
      if (!event.repeat) this.command('hold');
    });
    window.addEventListener('keyup', event => {  // a button with the focus is not pressed as well
      if (event.key === ' ' && event.target.type !== 'text') event.preventDefault();
    });
  }

  // Maps and clouds may come ten times a second: drawing them takes at most a fifth of the time.
  redrawMap(time) {
    if (!(this.mapOld || this.changes.dirty.size || this.cloud) || time < (this.nextMap || 0)) return;
    const begin = performance.now(), {view, changes} = this;
    if (this.mapOld) {
      view.drawMaps();
      if (view.maps.known) view.parts.setWindow(view.maps.grown);
    } else if (changes.dirty.size) {
      view.mapLayers.refresh(changes.dirty);
    }
    if (changes.dirty.size && view.maps.known) view.parts.setChanges(view.maps.known, changes.places);
    changes.clear();
    if (this.cloud) this.drawCloud(this.cloud);
    this.cloud = null;
    this.mapOld = false;
    this.nextMap = time + Math.max(0.2, 5e-3 * (performance.now() - begin));
  }

  // The newest report of each node: how long its stage took, or its code, with the sentence as a hint.
  onReport(m) {
    if (m.code === 'ok' && m.request_id === 0) return;
    this.reports.set(m.node, m);
    const place = report => (kStages.indexOf(report.stage) + kStages.length + 1) % (kStages.length + 1);
    const sorted = [...this.reports.values()].sort((a, b) => place(a) - place(b));
    $('reports').replaceChildren(...sorted.flatMap(report => {
      const dt = document.createElement('dt'), dd = document.createElement('dd');
      const good = report.code === 'ok';
      dt.textContent = report.stage === 'other' ? report.node : report.stage;
      dt.title = report.node;
      dd.textContent = good ? this.took(report.compute_ns) : report.code;
      dd.className = good ? '' : 'bad';
      dd.title = report.message;
      return [dt, dd];
    }));
  }

  took(ns) {
    if (!(ns >= 1000)) return 'ok';  // stages that do not compute
    return ns < 1e5 ? `${Math.round(ns / 1e3)} µs` : `${(ns / 1e6).toFixed(2)} ms`;
  }

  step(time) {
    if (this.view) this.redrawMap(time);
    if (!this.pose) return;
    if (this.view) this.view.setVehicle(this.pose.p, this.pose.q);
    if (!this.fresh || time - (this.drawn || 0) < 0.15) return;
    this.drawn = time;
    this.fresh = false;
    if (this.view && this.track.length > 1) this.view.setFlown(this.track);
    this.showGlance();
    const style = this.style(), span = [this.now - kPlotted, this.now];
    Object.values(this.curves).forEach((points, k) => {
      while (points.length && points[0][0] < span[0]) points.shift();
      this.plots[k].set(span, [{name: 'flown', color: style.plan, points, width: 1.8}], this.now);
    });
    this.plotsOld = true;
  }
};
