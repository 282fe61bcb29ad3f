// Plots against time on a canvas of their own: what was planned, what was flown, and the limit.
'use strict';
Goshawk.Plot = class {
  // @param limit of a dashed line, or null; least: lowest upper end of the axis [unit], so that noise
  // looks small; absent: the text of an empty plot
  constructor(canvas, {title, unit, limit = null, scale = 1, least = 0.1, absent = 'no data yet'}) {
    Object.assign(this, {canvas, title, unit, limit, scale, least, absent, series: [], zero: 0});
    this.set([0, 1], []);
  }

  // series: [{name, color, points: [[t, value], ...], width}]; zero: the time that the axis calls 0
  set(span, series, zero = span[0]) {
    Object.assign(this, {span, series, zero});
    let top = this.limit === null ? 0 : this.limit * this.scale;
    for (const s of series) for (const [, v] of s.points) top = Math.max(top, v * this.scale);
    this.top = 1.12 * Math.max(top, this.least);
    this.empty = series.every(s => !s.points.length);
  }

  x(t) { return this.left + (t - this.span[0]) / (this.span[1] - this.span[0]) * this.width; }
  y(v) { return this.bottom - v * this.scale / this.top * (this.bottom - this.upper); }
  timeAt(clientX) {
    const r = this.canvas.getBoundingClientRect();
    const s = (clientX - r.left - this.left) / this.width;
    return this.span[0] + Math.max(0, Math.min(1, s)) * (this.span[1] - this.span[0]);
  }

  draw(now, style) {
    const ratio = Math.min(window.devicePixelRatio || 1, 2), c = this.canvas;
    const w = c.clientWidth, h = c.clientHeight;
    if (!w) return;  // hidden: a narrow window shows one plot
    if (c.width !== Math.round(w * ratio) || c.height !== Math.round(h * ratio)) {
      c.width = Math.round(w * ratio);
      c.height = Math.round(h * ratio);
    }
    const g = c.getContext('2d');
    g.setTransform(ratio, 0, 0, ratio, 0, 0);
    g.clearRect(0, 0, w, h);
    this.left = 34; this.width = w - 44; this.upper = 24; this.bottom = h - 18;
    g.font = '11px ' + style.font;
    this.drawFrame(g, w, style);
    if (this.empty) return this.drawAbsent(g, style);
    this.drawTimes(g, style);
    for (const s of this.series) this.drawSeries(g, s);
    if (this.limit !== null) this.drawLimit(g, style);
    this.drawCursor(g, now, style);
    this.drawLegend(g, w, style);
  }

  drawFrame(g, w, style) {
    g.fillStyle = style.text;
    g.textAlign = 'left';
    g.fillText(this.title, this.left, 13);
    this.headEnd = this.left + g.measureText(this.title).width;
    g.fillStyle = style.soft;
    g.textAlign = 'right';
    g.fillText(this.unit, w - 10, 13);
    const step = Goshawk.tickStep(this.top, 4);
    g.strokeStyle = style.line;
    g.lineWidth = 1;
    for (let v = 0; v <= this.top; v += step) {
      const y = Math.round(this.y(v / this.scale)) + 0.5;
      g.beginPath(); g.moveTo(this.left, y); g.lineTo(this.left + this.width, y); g.stroke();
      if (!this.empty) g.fillText(String(+v.toPrecision(3)), this.left - 6, y + 3.5);
    }
  }

  drawAbsent(g, style) {
    g.fillStyle = style.soft;
    g.textAlign = 'center';
    g.fillText(this.absent, this.left + this.width / 2, (this.upper + this.bottom) / 2);
  }

  // Seconds from the zero on; the last one has its unit.
  drawTimes(g, style) {
    const [begin, end] = this.span.map(t => t - this.zero);
    const step = Goshawk.tickStep(end - begin, Math.max(2, Math.min(8, this.width / 60)));
    const last = Math.floor(end / step + 1e-6);
    g.fillStyle = style.soft;
    g.strokeStyle = style.line;
    for (let k = Math.ceil(begin / step - 1e-6); k <= last; ++k) {
      const x = this.x(this.zero + k * step), words = String(+(k * step).toFixed(3)) + (k === last ? ' s' : '');
      g.beginPath(); g.moveTo(x, this.bottom); g.lineTo(x, this.bottom + 4); g.stroke();
      const half = g.measureText(words).width / 2;
      g.textAlign = 'center';
      g.fillText(words, Math.min(x, this.left + this.width + 8 - half), this.bottom + 14);
    }
  }

  drawSeries(g, {color, points, width = 1.5}) {
    g.strokeStyle = color;
    g.lineWidth = width;
    g.lineJoin = 'round';
    g.beginPath();
    points.forEach(([t, v], k) => k ? g.lineTo(this.x(t), this.y(v)) : g.moveTo(this.x(t), this.y(v)));
    g.stroke();
  }

  drawLimit(g, style) {
    g.save();
    g.setLineDash([5, 4]);
    g.strokeStyle = style.limit;
    g.lineWidth = 1.2;
    g.beginPath(); g.moveTo(this.left, this.y(this.limit));
    g.lineTo(this.left + this.width, this.y(this.limit)); g.stroke();
    g.restore();
  }

  drawCursor(g, now, style) {
    const x = this.x(now), last = this.series[this.series.length - 1];
    g.strokeStyle = style.cursor;
    g.lineWidth = 1;
    g.beginPath(); g.moveTo(x, this.upper - 4); g.lineTo(x, this.bottom); g.stroke();
    const value = last && Goshawk.valueAt(last.points, now);
    if (value === null || value === undefined) return;
    g.fillStyle = last.color;
    g.beginPath(); g.arc(x, this.y(value), 3.2, 0, 7); g.fill();
    g.textAlign = 'left';
    g.fillStyle = style.text;
    const words = (value * this.scale).toFixed(2);
    g.fillText(words, this.headEnd + 10, 13);
    this.headEnd += 10 + g.measureText('0.00').width;  // the legend rests while values change
  }

  // Which line is which, from the right, as far as there is room.
  drawLegend(g, w, style) {
    const entries = this.series.map(s => ({name: s.name, color: s.color, width: Math.min(3, s.width || 1.5)}));
    if (this.limit !== null) entries.push({name: 'limit', color: style.limit, width: 1.2, dash: [4, 3]});
    let x = w - 10 - g.measureText(this.unit).width - 10;
    for (const {name, color, width, dash} of entries.reverse()) {
      const begin = x - g.measureText(name).width - 16;
      if (begin < this.headEnd + 8) return;
      g.save();
      g.setLineDash(dash || []);
      g.strokeStyle = color;
      g.lineWidth = width;
      g.beginPath(); g.moveTo(begin, 9.5); g.lineTo(begin + 12, 9.5); g.stroke();
      g.restore();
      g.textAlign = 'left';
      g.fillStyle = style.soft;
      g.fillText(name, begin + 16, 13);
      x = begin - 9;
    }
  }
};

// The smallest of 1, 2, 5 times a power of ten that goes into a length at most `most` times.
Goshawk.tickStep = function(length, most) {
  if (!(length > 0)) return 1;
  const power = 10 ** Math.floor(Math.log10(length / most));
  return [1, 2, 5, 10].map(s => s * power).find(s => length / s <= most + 1e-9) || 10 * power;
};

// Linear between samples [[t, value], ...]; null outside.
Goshawk.valueAt = function(points, t) {
  if (!points.length || t < points[0][0] || t > points[points.length - 1][0]) return null;
  let lo = 0, hi = points.length - 1;
  while (hi - lo > 1) {
    const mid = (lo + hi) >> 1;
    if (points[mid][0] <= t) lo = mid; else hi = mid;
  }
  const [t0, a] = points[lo], [t1, b] = points[hi];
  return t1 > t0 ? a + (b - a) * (t - t0) / (t1 - t0) : a;
};
