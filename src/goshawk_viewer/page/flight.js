// The page of one flight, with all its data in the file.
'use strict';
Goshawk.FlightPage = class extends Goshawk.Page {
  constructor(data) {
    super();
    this.data = data;
    this.legs = data.legs.map(leg => ({
      ...leg, trajectory: leg.pieces.length ? new Goshawk.Trajectory(leg.pieces) : null,
      stopAfter: leg.stop_after || 0,
      nominal: leg.nominal && leg.nominal.length ? new Goshawk.Trajectory(leg.nominal) : null}));
    this.followed = Goshawk.followedLegs(this.legs);
    // Of plans that newer ones replaced in flight, only what was followed is drawn, and the newest at each time.
    this.kept = this.legs.filter(leg => !leg.trajectory || this.followed.some(f => f.leg === leg && f.whole));
    this.changes = new Goshawk.MapChanges();
    const f = data.flown;
    this.track = f.t.map((t, k) => ({t, p: f.p.slice(3 * k, 3 * k + 3), v: f.v.slice(3 * k, 3 * k + 3),
                                     q: f.q.slice(4 * k, 4 * k + 4)}));
    this.begin = this.track.length ? this.track[0].t : 0;
    this.end = this.track.length ? this.track[this.track.length - 1].t :
        Math.max(0, ...this.legs.filter(l => l.trajectory).map(l => l.start + l.trajectory.duration));
    this.playing = false;
    if (this.view) this.fillView();
    this.fillPanel();
    this.fillPlots();
    this.bindTime();
    this.setTime(this.begin);
    const some = data.obstacles || data.grown || this.legs.length || this.track.length;
    this.hint(some || !this.view ? '' : 'This file holds no map, no plan and no flight.');
  }

  framed() {
    const points = [...this.track.map(s => s.p), ...this.data.stops];
    for (const leg of this.kept) points.push(...leg.waypoints, ...leg.raw);
    return points;
  }

  fillView() {
    const view = this.view, data = this.data;
    view.bodyRadius = data.body_radius;
    view.speedScale = data.limits.v_max;
    view.makeVehicle();
    if (data.obstacles) view.maps.obstacles = Goshawk.Voxels.fromRuns(data.obstacles);
    if (data.grown) view.maps.grown = Goshawk.Voxels.fromRuns(data.grown);
    if (data.growth) this.fillGrowth();
    view.setLegs(this.kept, this.followed);
    view.setFlown(this.track);
    const map = view.solid();
    if (map) {
      this.setCutRange(map.origin[2], map.upper(2), Goshawk.bestCut(map, this.framed()));
    } else {
      $('cut-row').hidden = true;
    }
    view.drawMaps();
    view.setGoals(data.stops);
    view.frame(this.framed());
    const refused = this.fillRefused();
    const moved = data.movers.length + data.predictions.length > 0;
    const parted = this.legs.some(leg => leg.stopAfter > 0);
    this.showLayers({grown: data.grown, flown: this.track.length, vehicle: this.track.length || this.legs.length,
                     unseen: data.growth, changed: data.growth, cloud: false, window: data.growth, movers: moved,
                     nominal: parted, stop: parted, refused});
  }

  // The map as the vehicle had it at each time; the true world stays as a shadow of it.
  fillGrowth() {
    const {view} = this;
    this.growth = new Goshawk.Growth(this.data.growth);
    this.growth.seek(Infinity, this.changes);
    view.maps.world = view.maps.obstacles;
    $('layer-above').parentElement.lastChild.textContent = 'the true world';
    $('layer-above').parentElement.hidden = !view.maps.world;
    Object.assign(view.maps, {obstacles: this.growth.obstacles, known: this.growth.known});
    this.changes.clear();
  }

  // @return whether something was refused
  fillRefused() {
    const {summary, obstacles, growth} = this.data;
    const leg = summary && (summary.legs || []).find(l => !l.arrived);
    if (!leg) return false;
    const voxel = summary.why && summary.why.voxel, map = growth || obstacles || this.data.grown;
    this.view.parts.setRefused({voxel: voxel && map ? {center: voxel.center, size: map.resolution} : null,
                                goal: leg.goal, path: leg.path ? leg.path.points : []});
    return true;
  }

  fillPanel() {
    const {limits, title, summary} = this.data;
    document.title = title;
    $('title').textContent = title;
    $('speed-top').textContent = limits.v_max;
    const facts = [];
    const duration = this.end - this.begin;
    const planned = Goshawk.plannedTime(this.legs);
    if (planned > 0) facts.push(['planned', planned.toFixed(2) + ' s']);
    if (this.track.length) {
      let length = 0, top = 0;
      this.track.forEach((s, k) => {
        if (k) length += V3.norm(V3.add(s.p, this.track[k - 1].p, -1));
        top = Math.max(top, V3.norm(s.v));
      });
      facts.push(['recorded', duration.toFixed(2) + ' s'], ['flown', length.toFixed(2) + ' m'],
                 ['top speed', top.toFixed(2) + ' m/s']);
    }
    facts.push(['limits', `${limits.v_max} m/s, ${limits.a_max} m/s²`]);
    if (summary) {
      if (summary.clearance) facts.push(['clearance', summary.clearance.smallest_m.toFixed(3) + ' m']);
      if (summary.tracking) facts.push(['tracking rms', (1e3 * summary.tracking.rms_error_m).toFixed(1) + ' mm']);
      $('badge').hidden = false;
      $('badge').textContent = summary.verdict;
      $('badge').className = summary.verdict === 'safe' ? '' : 'bad';
      const {why} = summary;
      if (summary.code !== 'ok') {
        $('sentence').textContent = why ? `${summary.code}: ${why.because} ${why.mend}` :
            `${summary.code}: ${summary.message}`;
      }
    }
    this.setFacts(facts);
  }

  // The planned state at a time; after a leg's end, its last state.
  plannedAt(t) {
    const leg = Goshawk.legAt(this.legs, t);
    return leg && leg.trajectory.sample(t - leg.start);
  }

  fillPlots() {
    this.makePlots(this.data.limits);
    const flown = {speed: [], acceleration: [], error: []}, plan = {speed: [], acceleration: []};
    const reach = Math.max(1, Math.round(0.05 / this.spacing()));
    this.track.forEach((s, k) => {
      flown.speed.push([s.t, V3.norm(s.v)]);
      const a = this.track[Math.max(0, k - reach)], b = this.track[Math.min(this.track.length - 1, k + reach)];
      if (b.t > a.t) flown.acceleration.push([s.t, V3.norm(V3.add(b.v, a.v, -1)) / (b.t - a.t)]);
      const wanted = this.plannedAt(s.t);
      if (wanted) flown.error.push([s.t, V3.norm(V3.add(s.p, wanted.position, -1))]);
    });
    for (let k = 0; k <= 800; ++k) {
      const t = this.begin + (this.end - this.begin) * k / 800, s = this.plannedAt(t);
      if (!s) continue;
      plan.speed.push([t, V3.norm(s.velocity)]);
      plan.acceleration.push([t, V3.norm(s.acceleration)]);
    }
    this.curves = {flown, plan};
    this.colorPlots();
  }

  spacing() {
    const n = this.track.length;
    return n > 1 ? Math.max(1e-3, (this.end - this.begin) / (n - 1)) : 0.02;
  }

  colorPlots() {
    if (!this.curves) return;
    const {flown, plan} = this.curves, style = this.style();
    const span = [this.begin, Math.max(this.end, this.begin + 1e-3)];
    const pair = name => [{name: 'planned', color: style.plan, points: plan[name], width: 3.2},
                          {name: 'flown', color: style.flown, points: flown[name], width: 1.2}]
        .filter(s => s.points.length);
    this.plots[0].set(span, pair('speed'));
    this.plots[1].set(span, pair('acceleration'));
    this.plots[2].set(span, [{name: 'flown', color: style.flown, points: flown.error, width: 1.2}]);
    this.plotsOld = true;
  }

  setTheme(name) {
    super.setTheme(name);
    this.colorPlots();
  }

  bindTime() {
    Object.assign($('time'), {min: this.begin, max: Math.max(this.end, this.begin + 1e-3), step: 0.001});
    $('time').addEventListener('input', () => this.setTime(Number($('time').value)));
    $('play').addEventListener('click', () => this.play(!this.playing));
    window.addEventListener('keydown', event => this.onTimeKey(event));
    for (const plot of this.plots) {
      const seek = event => this.setTime(plot.timeAt(event.clientX));
      plot.canvas.addEventListener('pointerdown', event => {
        plot.canvas.setPointerCapture(event.pointerId);
        seek(event);
      });
      plot.canvas.addEventListener('pointermove', event => { if (event.buttons) seek(event); });
    }
  }

  // Wherever the focus is, except where these keys have another meaning.
  onTimeKey(event) {
    const {id, tagName} = event.target;
    if (id !== 'time' && ['INPUT', 'BUTTON', 'SELECT'].includes(tagName)) return;
    const step = event.shiftKey ? 1 : 0.1;
    const keys = {' ': () => this.play(!this.playing), ArrowRight: () => this.setTime(this.now + step),
                  ArrowLeft: () => this.setTime(this.now - step), Home: () => this.setTime(this.begin),
                  End: () => this.setTime(this.end)};
    if (!keys[event.key]) return;
    event.preventDefault();
    keys[event.key]();
  }

  play(on) {
    this.playing = on;
    this.last = null;
    if (on && this.now >= this.end) this.setTime(this.begin);
    $('play').textContent = on ? '\u275A\u275A' : '\u25B6';
  }

  step(time) {
    if (!this.playing) return;
    if (this.last !== null) this.setTime(this.now + (time - this.last) * Number($('rate').value));
    this.last = time;
    if (this.now >= this.end) this.play(false);
  }

  // Position and attitude between the samples around t.
  poseAt(t) {
    const track = this.track;
    if (!track.length) {
      const s = this.plannedAt(t);
      return s && {p: s.position, q: [1, 0, 0, 0]};
    }
    let lo = 0, hi = track.length - 1;
    while (hi - lo > 1) {
      const mid = (lo + hi) >> 1;
      if (track[mid].t <= t) lo = mid; else hi = mid;
    }
    const a = track[lo], b = track[hi];
    const s = b.t > a.t ? Math.max(0, Math.min(1, (t - a.t) / (b.t - a.t))) : 0;
    const same = a.q.reduce((sum, c, k) => sum + c * b.q[k], 0) < 0 ? -1 : 1;
    const q = a.q.map((c, k) => c + s * (same * b.q[k] - c));
    const n = Math.hypot(...q) || 1;
    return {p: V3.mix(a.p, b.p, s), q: q.map(c => c / n)};
  }

  setTime(t) {
    this.now = Math.max(this.begin, Math.min(this.end, t));
    $('time').value = this.now;
    $('time-text').textContent = `${(this.now - this.begin).toFixed(2)} / ${(this.end - this.begin).toFixed(2)} s`;
    const pose = this.poseAt(this.now);
    if (this.view && pose) this.view.setVehicle(pose.p, pose.q);
    if (this.view) this.showMoment();
    this.plotsOld = true;
  }

  // What the picture shows of this moment alone: the map, the newest commit, what moves.
  showMoment() {
    const {view, data} = this;
    if (this.growth && this.growth.seek(this.now, this.changes)) {
      view.mapLayers.refresh(this.changes.dirty);
      view.parts.setChanges(this.growth.known, this.changes.places);
      view.parts.setWindow(this.growth.window());
      this.changes.clear();
    }
    const leg = Goshawk.legAt(this.legs, this.now) || null;
    if (leg !== this.shown) {
      this.shown = leg;
      view.setLegs(leg && !this.kept.includes(leg) ? [...this.kept, leg] : this.kept, this.followed);
      view.parts.setCommit(leg);
    }
    if (!data.movers.length && !data.predictions.length) return;
    const at = list => (list.findLast(m => m.t <= this.now && m.t > this.now - 2) || {boxes: []}).boxes;
    view.parts.setMovers(at(data.movers), at(data.predictions));
  }
};
