// What pages measure, and what they save as files.
'use strict';

// Where a ray first enters an occupied voxel below a layer. @param origin, way [m]: place and unit vector
// @return a place on its face, or null
Goshawk.castRay = (voxels, origin, way, layers = voxels.size[2]) => {
  const {resolution, cells} = voxels, size = [voxels.size[0], voxels.size[1], layers];
  const from = origin.map((c, i) => (c - voxels.origin[i]) / resolution);
  let enter = 0, leave = Infinity;
  for (let i = 0; i < 3; ++i) {
    const ends = [-from[i] / way[i], (size[i] - from[i]) / way[i]];  // infinite along a face
    if (Number.isNaN(ends[0]) || Number.isNaN(ends[1])) return null;
    enter = Math.max(enter, Math.min(...ends));
    leave = Math.min(leave, Math.max(...ends));
  }
  if (!(enter < leave)) return null;
  const start = V3.add(from, way, enter + 1e-9), cell = start.map((c, i) => Math.max(0, Math.min(size[i] - 1, Math.floor(c))));
  const next = cell.map((c, i) => (way[i] ? ((way[i] > 0 ? c + 1 : c) - from[i]) / way[i] : Infinity));
  let at = enter;
  for (;;) {
    if (cells[cell[0] + size[0] * (cell[1] + voxels.size[1] * cell[2])]) {
      return V3.add(origin, way, at * resolution);
    }
    const axis = [0, 1, 2].reduce((best, i) => (next[i] < next[best] ? i : best));
    at = next[axis];
    cell[axis] += Math.sign(way[axis]);
    if (!(cell[axis] >= 0 && cell[axis] < size[axis])) return null;
    next[axis] += 1 / Math.abs(way[axis]);
  }
};

// @param places one or two [m]
Goshawk.measureText = places => {
  if (places.length < 2) return `From ${places[0].map(c => c.toFixed(2)).join(', ')} m: click the second place.`;
  const [x, y, z] = V3.add(places[1], places[0], -1);
  return `${Math.hypot(x, y, z).toFixed(2)} m (level ${Math.hypot(x, y).toFixed(2)} m, up ${z.toFixed(2)} m)`;
};

// @param track [{t, p, v}]
Goshawk.trackCsv = track => ['t_s,x_m,y_m,z_m,vx_m_s,vy_m_s,vz_m_s',
                             ...track.map(s => [s.t, ...s.p, ...s.v].join())].join('\n') + '\n';

const escaped = text => text.replace(/&/g, '&amp;').replace(/</g, '&lt;');

// The plots as one drawing, beneath each other. @param style colours of the page's theme
Goshawk.plotsSvg = (plots, style, title) => {
  const width = 800, height = 220, left = 60, upper = 30, bottom = height - 34, right = width - 16;
  const text = (x, y, words, anchor = 'start') =>
      `<text x="${x}" y="${y}" text-anchor="${anchor}" fill="${style.text}">${escaped(words)}</text>`;
  const draw = (plot, k) => {
    const {span: [begin, end], top, scale, zero} = plot;
    const x = t => left + (t - begin) / (end - begin) * (right - left);
    const y = v => bottom - v * scale / top * (bottom - upper);
    const parts = [text(left, 18, `${plot.title} [${plot.unit}]`), text(right, height - 6, 'time [s]', 'end')];
    for (let v = 0, step = Goshawk.tickStep(top, 4); v <= top; v += step) {
      parts.push(`<path d="M${left} ${y(v / scale)}H${right}" stroke="${style.line}"/>`,
                 text(left - 6, y(v / scale) + 4, String(+v.toPrecision(3)), 'end'));
    }
    const step = Goshawk.tickStep(end - begin, 8);
    for (let n = Math.ceil((begin - zero) / step - 1e-6); zero + n * step <= end + 1e-9; ++n) {
      parts.push(text(x(zero + n * step), bottom + 16, String(+(n * step).toFixed(3)), 'middle'));
    }
    plot.series.forEach(({name, color, points, width: thick = 1.5}, i) => {
      const d = points.map(([t, v], n) => `${n ? 'L' : 'M'}${x(t).toFixed(2)} ${y(v).toFixed(2)}`).join('');
      parts.push(`<path d="${d}" fill="none" stroke="${color}" stroke-width="${thick}"/>`,
                 `<path d="M${right - 150 + 80 * i} 14h16" stroke="${color}" stroke-width="${thick}"/>`,
                 text(right - 130 + 80 * i, 18, name));
    });
    if (plot.limit !== null) {
      parts.push(`<path d="M${left} ${y(plot.limit)}H${right}" stroke="${style.limit}" stroke-dasharray="5 4"/>`);
    }
    return `<g transform="translate(0 ${30 + k * height})">${parts.join('')}</g>`;
  };
  const all = plots.length * height + 40;
  return `<svg xmlns="http://www.w3.org/2000/svg" width="${width}" height="${all}" font-family="sans-serif" ` +
      `font-size="12"><rect width="100%" height="100%" fill="${style.back}"/>${text(left, 22, title)}` +
      `${plots.map(draw).join('')}</svg>\n`;
};
