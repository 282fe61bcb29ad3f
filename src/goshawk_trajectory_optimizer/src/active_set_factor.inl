// The Hessian H of the jerk for one axis, block-tridiagonal with 3 x 3 blocks and the same for all
// three: H_kk = Q_(k-1) (second, second) + Q_k (first, first), H_(k,k-1) = Q_(k-1) (second, first),
// Q_k of piece k between knots k and k + 1. Included by active_set_kernels.inl.

// y = map (p, v, a of `knot`, p, v, a of the next)

GOSHAWK_INLINE Lanes point_at(const Lanes* x, int knot, const double* map) {
  const Lanes* v = x + 3 * knot;
  return map[0] * v[0] + map[1] * v[1] + map[2] * v[2] + map[3] * v[3] + map[4] * v[4] +
         map[5] * v[5];
}

// to = a^-1 by L D L', a symmetric 3 x 3. @return false if a is not positive definite
GOSHAWK_INLINE bool invert(const double* a, double* to) {
  const double d0 = a[0];
  if (!(d0 > 0.0 && d0 < 1e300)) return false;
  const double i0 = 1.0 / d0;
  const double l10 = a[3] * i0, l20 = a[6] * i0;
  const double d1 = a[4] - l10 * a[3];
  if (!(d1 > 0.0 && d1 < 1e300)) return false;
  const double i1 = 1.0 / d1;
  const double v21 = a[7] - l20 * a[3];
  const double l21 = v21 * i1;
  const double d2 = a[8] - l20 * a[6] - l21 * v21;
  if (!(d2 > 0.0 && d2 < 1e300)) return false;
  const double i2 = 1.0 / d2;
  const double m20 = l21 * l10 - l20;  // of L^-1
  to[8] = i2;
  to[5] = to[7] = -l21 * i2;
  to[2] = to[6] = m20 * i2;
  to[4] = i1 + l21 * l21 * i2;
  to[1] = to[3] = -l10 * i1 - l21 * m20 * i2;
  to[0] = i0 + l10 * l10 * i1 + m20 * m20 * i2;
  return true;
}

// to = a b, or a' b
template <bool TransposeA>
GOSHAWK_INLINE void product(const double* a, const double* b, double* to) {
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      const double a0 = TransposeA ? a[i] : a[3 * i];
      const double a1 = TransposeA ? a[3 + i] : a[3 * i + 1];
      const double a2 = TransposeA ? a[6 + i] : a[3 * i + 2];
      to[3 * i + j] = a0 * b[j] + a1 * b[3 + j] + a2 * b[6 + j];
    }
  }
}

void solve(ActiveSetState& s, int from);

// free = argmin without constraints: H x = -(Q_0 (second, first) x_start + Q_last (first, second)
// x_goal)
void find_free_minimum(ActiveSetState& s) {
  for (int i = 3; i < 3 * s.last; ++i) s.work[i] = Lanes{};
  for (int b = 0; b < 3; ++b) s.work[b] = s.work[3 * s.last + b] = Lanes{};
  for (int b = 0; b < 3; ++b) {
    s.free[b] = s.x[b];
    s.free[3 * s.last + b] = s.x[3 * s.last + b];
  }
  if (s.last < 2) return;
  const double* q0 = s.jerk;
  const double* q1 = s.jerk + 36 * (s.last - 1);
  const Lanes* start = s.x;
  const Lanes* goal = s.x + 3 * s.last;
  for (int r = 0; r < 3; ++r) {
    for (int c = 0; c < 3; ++c) {
      s.work[3 + r] -= q0[6 * (r + 3) + c] * start[c];
      s.work[3 * (s.last - 1) + r] -= q1[6 * r + c + 3] * goal[c];
    }
  }
  solve(s, 1);
  for (int i = 3; i < 3 * s.last; ++i) s.free[i] = s.work[i];
}

// H = L D L' by blocks: L_k = H_(k,k-1) D_(k-1)^-1, D_k = H_kk - L_k D_(k-1) L_k'.
bool factor(ActiveSetState& s) {
  for (int k = 1; k < s.last; ++k) {
    const double* before = s.jerk + 36 * (k - 1);
    const double* after = s.jerk + 36 * k;
    KnotFactor& f = s.factors[k];
    double d[9], b[9];
    for (int r = 0; r < 3; ++r) {
      for (int c = 0; c < 3; ++c) {
        d[3 * r + c] = before[6 * (r + 3) + c + 3] + after[6 * r + c];
        b[3 * r + c] = before[6 * (r + 3) + c];
      }
    }
    if (k > 1) {
      product<false>(b, s.factors[k - 1].inverse, f.below);
      for (int r = 0; r < 3; ++r) {
        for (int c = 0; c <= r; ++c) {
          const double fill = f.below[3 * r] * b[3 * c] + f.below[3 * r + 1] * b[3 * c + 1] +
                              f.below[3 * r + 2] * b[3 * c + 2];
          d[3 * r + c] -= fill;
        }
      }
    }
    if (!invert(d, f.inverse)) return false;
  }
  find_free_minimum(s);
  return true;
}

// map' H^-1 map of a point of knots k and k + 1: how far it gives way to a force of 1
GOSHAWK_INLINE double variance(const ActiveSetState& s, int k, const double* map) {
  double total = 0.0;
  const auto add = [&](const double* block, const double* left, const double* right, double by) {
    for (int r = 0; r < 3; ++r) {
      for (int c = 0; c < 3; ++c) total += by * left[r] * block[3 * r + c] * right[c];
    }
  };
  if (k > 0) add(s.factors[k].variance, map, map, 1.0);
  if (k + 1 < s.last) add(s.factors[k + 1].variance, map + 3, map + 3, 1.0);
  if (k > 0 && k + 1 < s.last) add(s.factors[k].covariance, map + 3, map, 2.0);
  return total;
}

GOSHAWK_INLINE double weight_of(double variance) {
  return variance > 0.0 && variance < 1e300 ? 1.0 / __builtin_sqrt(variance) : 1.0;
}

// Weights 1 / sqrt(map' H^-1 map) of all points. The blocks of H^-1 on and beside the diagonal, from
// the last knot back: V_k = D_k^-1 + L' V_(k+1) L, C_k = -V_(k+1) L with L = L_(k+1).
void weigh(ActiveSetState& s) {
  for (int k = s.last - 1; k >= 1; --k) {
    KnotFactor& f = s.factors[k];
    for (int i = 0; i < 9; ++i) f.variance[i] = f.inverse[i];
    if (k + 1 == s.last) continue;
    const KnotFactor& next = s.factors[k + 1];
    product<false>(next.variance, next.below, f.covariance);
    double add[9];
    product<true>(next.below, f.covariance, add);
    for (int i = 0; i < 9; ++i) {
      f.variance[i] += add[i];
      f.covariance[i] = -f.covariance[i];
    }
  }
  for (int p = 0; p < s.point_count; ++p) {
    PricedPoint& point = s.points[p];
    const double map[6] = {point.map[0], point.map[1], point.map[2], 0.0, 0.0, 0.0};
    point.weight = weight_of(variance(s, point.knot, map));
  }
  for (PricedSet& set : s.limits) {
    if (set.pieces == nullptr) continue;
    for (int k = 0; k < s.last; ++k) {
      PricedLimits& l = set.pieces[k];
      for (int lane = 0; lane < 4; ++lane) {
        double map[6];
        for (int b = 0; b < 6; ++b) map[b] = l.map[b][lane];
        l.weight[lane] = weight_of(variance(s, k, map));
      }
    }
  }
}
