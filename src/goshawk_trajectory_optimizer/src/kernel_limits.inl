// The limits: smooth convex rows g = q h - e with q = sum_c weight_c y_c^2, on a point y of two knots,
// and e = e1 eta + e0; four control points of a piece a vector. Velocity has h = 1; acceleration
// and jerk (Over) h = 1 / e, a quadratic over a linear function, which is as convex as the cone it
// stands for. Derivatives:
//
//   dg/dy_c = 2 h weight_c y_c =: G_c      dg/deta = -e1 (1 + q / e^2)    (Over; else -e1)
//   d2g/dy_c^2 = 2 h weight_c              d2g/(dy_c deta) = -G_c e1 / e  (Over; else 0)
//                                          d2g/deta^2 = 2 q e1^2 / e^3    (Over; else 0)

// y_c = sum over the six of (p, v, a of the first knot, p, v, a of the second), component c

GOSHAWK_INLINE void points_of(const LimitLanes& l, const Lanes* x, Lanes* y) {
  for (int c = 0; c < 3; ++c) {
    y[c] = l.map[0] * x[0][c] + l.map[1] * x[1][c] + l.map[2] * x[2][c] + l.map[3] * x[3][c] +
           l.map[4] * x[4][c] + l.map[5] * x[5][c];
  }
}

// What the four points of a piece add to the sums by y, a point a lane: w = sum z / s G G' +
// z d2g/dy^2 as xx xy xz yy yz zz, g = sum z G, pull = sum z / s r G, and the mixed terms with eta.
struct LimitSums {
  Lanes w[6] = {}, g[3] = {}, pull[3] = {}, border[3] = {};
};

// The Hessian of two knots += (m m') (x) W for one point's map m = (a of the first knot, b of the
// second). Maps at the ends of a piece have zeros, which saves half of the work.
GOSHAWK_INLINE void scatter_point(const double (*m)[4], int lane, Lanes w0, Lanes w1,
                                  KnotSums& first, KnotSums& second, PieceSums& piece) {
  const double a[3] = {m[0][lane], m[1][lane], m[2][lane]};
  const double b[3] = {m[3][lane], m[4][lane], m[5][lane]};
  const bool has_first = a[0] != 0.0 || a[1] != 0.0 || a[2] != 0.0;
  const bool has_second = b[0] != 0.0 || b[1] != 0.0 || b[2] != 0.0;
  if (has_first) add_diagonal(first, a, w0, w1);
  if (has_second) add_diagonal(second, b, w0, w1);
  if (!has_first || !has_second) return;
  for (int r = 0; r < 3; ++r) {
    const Lanes v0 = b[r] * w0, v1 = b[r] * w1;
    for (int c = 0; c < 3; ++c) {
      piece.block[3 * r + c][0] += a[c] * v0;
      piece.block[3 * r + c][1] += a[c] * v1;
    }
  }
}

// first[b] += m_b v, second[b] += m_(b + 3) v, summed over the four points of v
GOSHAWK_INLINE void scatter_vector(const double (*m)[4], Lanes* v, Lanes* first, Lanes* second,
                                   int stride) {
  Lanes p[4] = {v[0], v[1], v[2], Lanes{}};
  transpose(p[0], p[1], p[2], p[3]);
  for (int b = 0; b < 3; ++b) {
    for (int lane = 0; lane < 4; ++lane) {
      first[b * stride] += m[b][lane] * p[lane];
      second[b * stride] += m[b + 3][lane] * p[lane];
    }
  }
}

// From sums by y to sums by knots, with each point's map.
GOSHAWK_INLINE void scatter(const LimitLanes& l, LimitSums& to, bool scale, KnotSums& first,
                            KnotSums& second, PieceSums& piece) {
  const auto* m = reinterpret_cast<const double(*)[4]>(l.map);
  scatter_vector(m, to.g, first.dual, second.dual, 1);
  scatter_vector(m, to.pull, first.pull, second.pull, 1);
  if (scale) scatter_vector(m, to.border, first.border, second.border, 1);
  Lanes rest[4] = {to.w[4], to.w[5], Lanes{}, Lanes{}};
  transpose(to.w[0], to.w[1], to.w[2], to.w[3]);
  transpose(rest[0], rest[1], rest[2], rest[3]);
  for (int lane = 0; lane < 4; ++lane) {
    scatter_point(m, lane, to.w[lane], rest[lane], first, second, piece);
  }
}

struct LimitTotals {
  Lanes gap = {}, proof = {}, worst = {}, outside = {}, dual_eta = {}, pull_eta = {},
        hessian_eta = {};
};

// r, 1 / s, dg/deta and the sums of the limits of one derivative of piece k.
template <bool Over>
GOSHAWK_INLINE void linearise_limit(SplineState& w, const LimitSet& set, int k,
                                    LimitTotals& total) {
  LimitLanes& l = set.lanes[k];
  points_of(l, w.x + 3 * k, l.y);
  l.e = l.e1 * w.eta + l.e0;
  l.inverse_e = 1.0 / l.e;
  const Lanes g = Over ? l.inverse_e : all(1.0);
  LimitSums to;
  for (int r = 0; r < set.rows; ++r) {
    auto& row = l.row[r];
    if (w.step != 0.0) take_step(row, w.step);
    const Lanes wy[3] = {set.weights[r][0] * l.y[0], set.weights[r][1] * l.y[1],
                         set.weights[r][2] * l.y[2]};
    const Lanes q = wy[0] * l.y[0] + wy[1] * l.y[1] + wy[2] * l.y[2];
    const Lanes over = Over ? q * l.inverse_e * l.inverse_e : Lanes{};
    row.residual = q * g - l.e + row.s;
    row.inverse_s = 1.0 / row.s;
    const Lanes weight = row.z * row.inverse_s;
    row.slope_e = l.e1 * (-1.0 - over);
    total.gap += row.s * row.z;
    total.proof += row.z * row.residual;
    total.worst = larger(total.worst, magnitude(row.residual));
    total.outside = larger(total.outside, row.residual - row.s);
    total.dual_eta += row.z * row.slope_e;
    total.pull_eta += weight * row.residual * row.slope_e;
    total.hessian_eta += weight * row.slope_e * row.slope_e;
    if (Over) total.hessian_eta += 2.0 * row.z * over * l.inverse_e * l.e1 * l.e1;
    const Lanes twice = 2.0 * g;
    Lanes G[3], wG[3];
    for (int c = 0; c < 3; ++c) {
      G[c] = twice * wy[c];
      wG[c] = weight * G[c];
      to.g[c] += row.z * G[c];
      to.pull[c] += row.residual * wG[c];
      to.border[c] += wG[c] * row.slope_e;
      if (Over) to.border[c] -= row.z * G[c] * l.inverse_e * l.e1;
    }
    const Lanes bend = row.z * twice;
    to.w[0] += wG[0] * G[0] + bend * set.weights[r][0];
    to.w[1] += wG[0] * G[1];
    to.w[2] += wG[0] * G[2];
    to.w[3] += wG[1] * G[1] + bend * set.weights[r][1];
    to.w[4] += wG[1] * G[2];
    to.w[5] += wG[2] * G[2] + bend * set.weights[r][2];
  }
  scatter(l, to, w.scale, w.knots[k], w.knots[k + 1], w.pieces[k]);
}

// All pieces: residuals, G' z, G' (z / s) r and G' diag(z / s) G + sum z d2g.
template <bool Over>
void linearise_limits(SplineState& w, const LimitSet& set) {
  LimitTotals total;
  for (int k = 0; k < w.last; ++k) linearise_limit<Over>(w, set, k, total);
  w.gap += sum(total.gap);
  w.proof += sum(total.proof);
  w.primal_residual = larger(w.primal_residual, largest(total.worst));
  w.limit_violation = larger(w.limit_violation, largest(total.outside));
  w.dual_eta += sum(total.dual_eta);
  w.pull_eta += sum(total.pull_eta);
  w.hessian_eta += sum(total.hessian_eta);
}

// r = g + 1, and the largest g
template <bool Over>
void evaluate_limits(SplineState& w, const LimitSet& set) {
  Lanes outside = {};
  for (int k = 0; k < w.last; ++k) {
    LimitLanes& l = set.lanes[k];
    Lanes y[3];
    points_of(l, w.x + 3 * k, y);
    const Lanes e = l.e1 * w.eta + l.e0;
    for (int r = 0; r < set.rows; ++r) {
      Lanes q = set.weights[r][0] * y[0] * y[0] + set.weights[r][1] * y[1] * y[1] +
                set.weights[r][2] * y[2] * y[2];
      if (Over) q /= e;
      outside = larger(outside, q - e);
      l.row[r].residual = q - e + 1.0;
    }
  }
  w.limit_violation = larger(w.limit_violation, largest(outside));
}

// Along the step (dy, deta): slope = G . dy + dg/deta deta, and half the second derivative,
// bend = h sum_c weight_c (dy_c - y_c de / e)^2 (Over; else sum_c weight_c dy_c^2).
struct Along {
  Lanes slope, bend;
};
template <bool Over>
GOSHAWK_INLINE Along along(const SplineState& w, const LimitSet& set, const LimitLanes& l, int r,
                           const Lanes* dy, Lanes de) {
  const Lanes g = Over ? l.inverse_e : all(1.0);
  Along a{l.row[r].slope_e * w.deta, Lanes{}};
  for (int c = 0; c < 3; ++c) {
    const Lanes v = Over ? dy[c] - l.y[c] * de * l.inverse_e : dy[c];
    a.slope += 2.0 * g * set.weights[r][c] * l.y[c] * dy[c];
    a.bend += g * set.weights[r][c] * v * v;
  }
  return a;
}

// ds = -r - slope, dz = -z - z / s ds, target = ds dz.
// @return the largest of -ds / s and -dz / z
template <bool Over>
double predict_limits(SplineState& w, const LimitSet& set) {
  Lanes worst = {}, product = {};
  for (int k = 0; k < w.last; ++k) {
    LimitLanes& l = set.lanes[k];
    Lanes dy[3];
    points_of(l, w.dx + 3 * k, dy);
    const Lanes de = l.e1 * w.deta;
    for (int r = 0; r < set.rows; ++r) {
      auto& row = l.row[r];
      const Along a = along<Over>(w, set, l, r, dy, de);
      const Lanes ds = -row.residual - a.slope;
      const Lanes dz = -row.z - row.z * row.inverse_s * ds;
      const Lanes ratio = ds * row.inverse_s;
      worst = larger(worst, larger(-ratio, 1.0 + ratio));
      row.target = ds * dz;
      product += row.target;
    }
  }
  w.product += sum(product);
  return largest(worst);
}

// target = t = (mu - trust ds dz) / s, pull = G' (t + z / s r), with r what the predictor's step
// would leave in second order: r + reach^2 bend
template <bool Over>
void pull_limits(SplineState& w, const LimitSet& set, double mu) {
  Lanes pull_eta = {};
  for (int k = 0; k < w.last; ++k) {
    LimitLanes& l = set.lanes[k];
    const Lanes g = Over ? l.inverse_e : all(1.0);
    Lanes pull[3] = {};
    Lanes dy[3];
    points_of(l, w.dx + 3 * k, dy);
    const Lanes de = l.e1 * w.deta;
    for (int r = 0; r < set.rows; ++r) {
      auto& row = l.row[r];
      const Along a = along<Over>(w, set, l, r, dy, de);
      row.residual += w.reach * w.reach * a.bend;
      row.target = (mu - w.trust * row.target) * row.inverse_s;
      const Lanes c = row.target + row.z * row.inverse_s * row.residual;
      pull_eta += c * row.slope_e;
      for (int i = 0; i < 3; ++i) pull[i] += c * (2.0 * g * set.weights[r][i] * l.y[i]);
    }
    const auto* m = reinterpret_cast<const double(*)[4]>(l.map);
    scatter_vector(m, pull, w.knots[k].pull, w.knots[k + 1].pull, 1);
  }
  w.pull_eta += sum(pull_eta);
}

// residual = ds = -r - slope. @return the largest of -ds / s, -dz / z and -de / e
template <bool Over>
double finish_limits(SplineState& w, const LimitSet& set) {
  Lanes worst = {};
  for (int k = 0; k < w.last; ++k) {
    LimitLanes& l = set.lanes[k];
    Lanes dy[3];
    points_of(l, w.dx + 3 * k, dy);
    const Lanes de = l.e1 * w.deta;
    worst = larger(worst, -de * l.inverse_e);  // e stays above zero
    for (int r = 0; r < set.rows; ++r) {
      auto& row = l.row[r];
      const Along a = along<Over>(w, set, l, r, dy, de);
      const Lanes ds = -row.residual - a.slope;
      const Lanes dz = row.target - row.z - row.z * row.inverse_s * ds;
      worst = larger(worst, larger(-ds * row.inverse_s, -dz / row.z));
      row.residual = ds;
    }
  }
  return largest(worst);
}
