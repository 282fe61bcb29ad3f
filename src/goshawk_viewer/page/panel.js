// What both pages share: theme, legend, facts, plots, and the drawing loop.
'use strict';
const $ = id => document.getElementById(id);

Goshawk.layerNames = [
  ['obstacles', 'obstacles', t => t.high], ['above', 'above the cut', t => t.ghost, 'hollow'],
  ['grown', 'too close to fly', t => t.grown], ['unseen', 'edge of the unseen', t => t.unseen],
  ['changed', 'changed just now', () => 0xff731a], ['cloud', 'cloud', t => t.cloud],
  ['window', 'map window', t => t.ghost, 'hollow'], ['raw', 'voxel path', t => t.raw, 'thin'],
  ['pruned', 'pruned path', t => t.pruned, 'thin'], ['corridor', 'corridor', t => t.corridor],
  ['trajectory', 'plan, by speed', null], ['nominal', 'nominal part', t => t.nominal, 'thin'],
  ['stop', 'stop part', t => t.stop, 'thin'], ['flown', 'flown track', t => t.flown, 'thin'],
  ['movers', 'moving obstacles', t => t.mover], ['vehicle', 'vehicle', t => t.accent], ['goals', 'start and goals', t => t.goal, 'halves'],
  ['refused', 'what was refused', t => t.accent]];

Goshawk.Page = class {
  constructor() {
    this.view = this.makeView();
    this.plots = [];
    this.now = 0;
    this.buildLegend();
    this.bindButtons();
    this.bindFold();
    if (this.view) window.addEventListener('keydown', event => this.onViewKey(event));
    window.addEventListener('resize', () => { if (this.view) this.view.resize(); this.plotsOld = true; });
    this.setTheme(document.documentElement.dataset.theme);
  }

  makeView() {
    const probe = document.createElement('canvas');
    let gl = null;
    try {
      gl = probe.getContext('webgl') || probe.getContext('experimental-webgl');
    } catch (error) { gl = null; }
    if (gl) {
      try { return new Goshawk.View($('view')); } catch (error) { console.warn(String(error)); }
    }
    $('no-webgl').hidden = false;
    $('view').hidden = true;
    for (const id of ['cut-row', 'follow', 'home', 'layers', 'speed-scale', 'height-row', 'goal', 'measure', 'compass',
                      'save-png']) {
      $(id).hidden = true;
    }
    return null;
  }

  buildLegend() {
    for (const [name, text, , shape] of Goshawk.layerNames) {
      const label = document.createElement('label');
      const box = document.createElement('input');
      box.type = 'checkbox';
      box.id = 'layer-' + name;
      box.checked = !this.view || this.view.layers[name].visible;
      box.addEventListener('change', () => {
        this.view.layers[name].visible = box.checked;
        if (Goshawk.MapLayers.names.includes(name)) this.view.drawMaps();  // made when shown
        this.onLayer(name, box.checked);
        this.view.redraw = true;
      });
      const swatch = document.createElement('i');
      if (shape) swatch.className = shape;
      label.append(box, swatch, text);
      $('layers').append(label);
    }
    const stops = [0, 0.2, 0.4, 0.6, 0.8, 1].map(s =>
        `rgb(${Goshawk.speedColor(s).map(c => Math.round(255 * c)).join(',')})`);
    this.gradient = `linear-gradient(90deg, ${stops.join(',')})`;
    $('speed-scale').querySelector('i').style.background = this.gradient;
  }

  // A layer was shown or hidden.
  onLayer() {}

  // The live page takes goals by clicks.
  aim() {}

  // Layers without content are not in the legend. @param have {name: whether there is something}
  showLayers(have) {
    for (const [name, there] of Object.entries(have)) {
      $('layer-' + name).parentElement.hidden = !there;
      if (!there) this.view.layers[name].visible = false;
    }
  }

  bindButtons() {
    $('theme').addEventListener('click', () => {
      this.setTheme(document.documentElement.dataset.theme === 'dark' ? 'light' : 'dark');
    });
    $('follow').addEventListener('click', () => this.follow());
    $('home').addEventListener('click', () => this.view.frame(this.framed()));
    const plots = [...$('plots').querySelectorAll('canvas')];
    plots[0].className = 'shown';
    $('next-plot').addEventListener('click', () => {  // narrow windows have room for one
      const k = plots.findIndex(c => c.className === 'shown');
      plots[k].className = '';
      plots[(k + 1) % plots.length].className = 'shown';
      this.plotsOld = true;
    });
    for (const kind of ['png', 'svg', 'csv']) $('save-' + kind).addEventListener('click', () => this.save(kind));
    this.bindMeasure();
    let timer = 0;
    $('cut').addEventListener('input', () => {
      $('cut-text').textContent = Number($('cut').value).toFixed(1) + ' m';
      clearTimeout(timer);
      timer = setTimeout(() => this.view.setCut(Number($('cut').value)), 30);
    });
  }

  // Distances between two places that are clicked: of the map, or of the plane at the vehicle's height.
  measure(on) {
    if (on) this.aim(false);  // a click measures or sends a goal, never both
    this.measuring = on ? [] : null;
    $('measure').setAttribute('aria-pressed', on);
    document.body.classList.toggle('aiming', on);
    $('measured').textContent = on ? 'Click the first place.' : '';
    this.view.setMeasure([]);
  }

  bindMeasure() {
    const canvas = $('view');
    let down = null;
    $('measure').addEventListener('click', () => this.measure(!this.measuring));
    canvas.addEventListener('pointerdown', event => { down = [event.clientX, event.clientY]; });
    canvas.addEventListener('pointerup', event => {
      if (!this.measuring || !down || Math.hypot(event.clientX - down[0], event.clientY - down[1]) > 4) return;
      const place = this.view.touch(event);
      if (!place) return;
      this.measuring = [...this.measuring.slice(this.measuring.length === 2 ? 2 : 0), place];
      this.view.setMeasure(this.measuring);
      $('measured').textContent = Goshawk.measureText(this.measuring);
    });
  }

  // Into the browser's downloads.
  save(kind) {
    const text = {svg: () => Goshawk.plotsSvg(this.plots, this.style(), $('title').textContent),
                  csv: () => Goshawk.trackCsv(this.track || [])};
    const types = {svg: 'image/svg+xml', csv: 'text/csv'};
    const link = document.createElement('a');
    link.download = `${$('title').textContent.replace(/[^\w.-]+/g, '_')}.${kind}`;
    link.href = kind === 'png' ? this.view.pictureUrl() :
        URL.createObjectURL(new Blob([text[kind]()], {type: types[kind]}));
    link.click();
    if (kind !== 'png') setTimeout(() => URL.revokeObjectURL(link.href), 10000);
  }

  follow() {
    this.view.follow = !this.view.follow;
    $('follow').setAttribute('aria-pressed', this.view.follow);
  }

  // In a narrow window the panel is folded at first.
  bindFold() {
    const fold = open => {
      $('fold').setAttribute('aria-expanded', open);
      $('folded').hidden = !open;
    };
    $('fold').addEventListener('click', () => fold($('folded').hidden));
    fold(window.innerWidth > 760);
  }

  // Keys for what the pointer does.
  onViewKey(event) {
    if (event.ctrlKey || event.metaKey || event.altKey || event.target.type === 'text') return;
    const turns = {a: [-0.1, 0, 1], d: [0.1, 0, 1], w: [0, 0.07, 1], s: [0, -0.07, 1], '+': [0, 0, 0.9],
                   '=': [0, 0, 0.9], '-': [0, 0, 1 / 0.9]};
    const key = event.key.toLowerCase();
    if (turns[key]) this.view.turn(...turns[key]);
    if (key === '0') this.view.frame(this.framed());
    if (key === 'f') this.follow();
    if (key === 'm') this.measure(!this.measuring);
    if (key === 'escape' && this.measuring) this.measure(false);
  }

  // @param at where the map is cut at first [m]
  setCutRange(lower, upper, at) {
    Object.assign($('cut'), {min: lower, max: upper, step: 0.1});
    $('cut').value = at;
    $('cut-text').textContent = Number($('cut').value).toFixed(1) + ' m';
    this.view.cut = Number($('cut').value);
  }

  setTheme(name) {
    document.documentElement.dataset.theme = name;
    $('theme').textContent = name === 'dark' ? 'Light' : 'Dark';
    if (this.view) this.view.setTheme(name);
    const theme = Goshawk.themes[name];
    const swatches = $('layers').querySelectorAll('i');
    Goshawk.layerNames.forEach(([, , color], k) => {
      const css = hex => '#' + hex.toString(16).padStart(6, '0');
      swatches[k].style.background = !color ? this.gradient : swatches[k].className === 'halves' ?
          `linear-gradient(90deg, ${css(theme.body)} 50%, ${css(color(theme))} 50%)` : css(color(theme));
    });
    this.plotsOld = true;
  }

  style() {
    const css = getComputedStyle(document.documentElement);
    const get = name => css.getPropertyValue('--' + name).trim();
    return {font: get('font'), text: get('text'), soft: get('soft'), line: get('line'), limit: get('limit'),
            cursor: get('soft'), back: get('back'), flown: get('flown'), plan: get('plan')};
  }

  setFacts(facts) {
    $('facts').replaceChildren(...facts.flatMap(([name, value]) => {
      const dt = document.createElement('dt'), dd = document.createElement('dd');
      dt.textContent = name;
      dd.textContent = value;
      return [dt, dd];
    }));
  }

  makePlots(limits) {
    const canvases = $('plots').querySelectorAll('canvas');
    this.plots = [
      new Goshawk.Plot(canvases[0], {title: 'speed', unit: 'm/s', limit: limits && limits.v_max}),
      new Goshawk.Plot(canvases[1], {title: 'acceleration', unit: 'm/s²', limit: limits && limits.a_max}),
      new Goshawk.Plot(canvases[2], {title: 'tracking error', unit: 'mm', scale: 1000, least: 1,
                                      absent: 'nothing flown yet'}),
    ];
  }

  drawPlots() {
    const style = this.style();
    for (const plot of this.plots) plot.draw(this.now, style);
  }

  // Says in the middle of the picture what is missing; '': nothing.
  hint(text) {
    if ($('hint').textContent !== text) $('hint').textContent = text;
  }

  run() {
    const frame = time => {
      this.step(time / 1000);
      if (this.view) this.view.render();
      if (this.plotsOld) { this.plotsOld = false; this.drawPlots(); }
      requestAnimationFrame(frame);
    };
    requestAnimationFrame(frame);
  }
};
