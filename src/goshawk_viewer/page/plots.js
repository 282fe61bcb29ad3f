// Plots against time on a canvas of their own: what was planned, what was flown, and the limit.
'use strict';
Goshawk.Plot = class {
  // @param limit a dashed line, or null
  constructor(canvas, {title, unit, limit = null, scale = 1}) {
    Object.assign(this, {canvas, title, unit, limit, scale, series: []});
    this.span = [0, 1];
  }

  // series: [{color, points: [[t, value], ...], width}]
  set(span, series) {
    this.span = span;
    this.series = series;
    let top = this.limit === null ? 0 : this.limit * this.scale;
    for (const s of series) for (const [, v] of s.points) top = Math.max(top, v * this.scale);
    this.top = 1.12 * (top || 1);
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
    if (c.width !== Math.round(w * ratio) || c.height !== Math.round(h * ratio)) {
      c.width = Math.round(w * ratio);
      c.height = Math.round(h * ratio);
    }
    const g = c.getContext('2d');
    g.setTransform(ratio, 0, 0, ratio, 0, 0);
    g.clearRect(0, 0, w, h);
    this.left = 34; this.width = w - 44; this.upper = 22; this.bottom = h - 6;
    g.font = '11px ' + style.font;
    this.drawFrame(g, w, style);
    for (const s of this.series) this.drawSeries(g, s);
    if (this.limit !== null) this.drawLimit(g, style);
    this.drawCursor(g, now, style);
  }

  drawFrame(g, w, style) {
    g.fillStyle = style.text;
    g.textAlign = 'left';
    g.fillText(this.title, this.left, 13);
    g.fillStyle = style.soft;
    g.textAlign = 'right';
    g.fillText(this.unit, w - 10, 13);
    const step = [0.1, 0.2, 0.5, 1, 2, 5, 10, 20, 50, 100, 200, 500, 1000].find(s => this.top / s <= 4) || this.top / 3;
    g.strokeStyle = style.line;
    g.lineWidth = 1;
    for (let v = 0; v <= this.top; v += step) {
      const y = Math.round(this.y(v / this.scale)) + 0.5;
      g.beginPath(); g.moveTo(this.left, y); g.lineTo(this.left + this.width, y); g.stroke();
      g.fillText(String(+v.toPrecision(3)), this.left - 6, y + 3.5);
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
    g.fillText((value * this.scale).toFixed(2), this.left + g.measureText(this.title).width + 10, 13);
  }
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
