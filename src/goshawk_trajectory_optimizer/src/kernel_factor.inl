// The Newton system of the inner knots and eta,
//
//   | A_1  B_1'           c_1 |
//   | B_1  A_2  B_2'      c_2 |      A_k 9 x 9: knot k with itself; B_k: knot k + 1 with k;
//   |      B_2  A_3  ...  c_3 |      c_k: knot k with eta; corner: eta with itself,
//   | c_1' c_2' c_3' ...  corner |
//
// factored as L D L' with D diagonal. Work is linear in the number of knots.

GOSHAWK_INLINE const double* at(const Lanes* lanes) {
  return reinterpret_cast<const double*>(lanes);
}
GOSHAWK_INLINE double* at(Lanes* lanes) {
  return reinterpret_cast<double*>(lanes);
}

// Where (row axis, column axis) stands in a symmetric block.
constexpr int kSymmetric[3][3] = {{0, 1, 2}, {1, 3, 4}, {2, 4, 5}};
constexpr int kDiagonal[3][3] = {{0, 1, 2}, {1, 3, 4}, {2, 4, 5}};  // block of a knot

// Column 3 c + axis of a knot's panel.
GOSHAWK_INLINE void expand(const KnotSums& knot, const PieceSums* piece, int c, int axis,
                           double* column) {
  for (int r = 0; r < 3; ++r) {
    const double* block = at(knot.block[kDiagonal[r][c]]);
    for (int i = 0; i < 3; ++i) column[3 * r + i] = block[kSymmetric[i][axis]];
  }
  const double border = at(knot.border)[4 * c + axis];
  column[9] = column[21] = border;
  column[10] = column[11] = column[22] = column[23] = 0.0;
  for (int r = 0; r < 3; ++r) {
    const double* block = piece != nullptr ? at(piece->block[3 * r + c]) : nullptr;
    for (int i = 0; i < 3; ++i) {
      column[12 + 3 * r + i] = block != nullptr ? block[kSymmetric[i][axis]] : 0.0;
    }
  }
}

// Columns of L below a panel's diagonal block: only the next panel needs them.
struct Below {
  Lanes l[9][3];
};

// Column c of L D = column c of (A, B, border) - sum over earlier columns j of (L D)_j L_cj, those of
// the panel before and of this one: each is finished in registers. corner -= (L D)_border^2 / d.
// @return false if the matrix is not positive definite
GOSHAWK_INLINE bool factor_panel(Panel& panel, Below& below, const Panel* before,
                                 const Below& below_before, double& corner) {
  double* const inverse_d = at(panel.inverse_d);
#pragma GCC unroll 9
  for (int c = 0; c < 9; ++c) {
    Lanes a[6];
    for (int i = 0; i < 6; ++i) a[i] = panel.u[c][i];
    if (before != nullptr) {
#pragma GCC unroll 9
      for (int j = 0; j < 9; ++j) {
        const Lanes factor = all(at(below_before.l[j])[c]);
        for (int i = 0; i < 3; ++i) a[i] -= factor * before->u[j][3 + i];
      }
    }
#pragma GCC unroll 9
    for (int j = 0; j < c; ++j) {
      const Lanes factor = all(at(panel.u[j])[c] * inverse_d[j]);
      for (int i = c / 4; i < 6; ++i) a[i] -= factor * panel.u[j][i];
    }
    // The border below is the border: row 21 follows row 9.
    a[5][1] = a[2][1];
    const double d = a[c / 4][c % 4];
    if (!(d > 0.0) || !(d < 1e300)) return false;
    inverse_d[c] = 1.0 / d;
    const Lanes inverse = all(inverse_d[c]);
    for (int i = 0; i < 6; ++i) panel.u[c][i] = a[i];
    for (int i = 0; i < 3; ++i) below.l[c][i] = a[3 + i] * inverse;
    for (int j = c + 1; j < 9; ++j) at(panel.transposed[j])[c] = at(panel.u[c])[j] * inverse_d[c];
    corner -= a[2][1] * a[2][1] * inverse_d[c];
  }
  return true;
}

// symmetric block times vector
GOSHAWK_INLINE void add_product(const Lanes* block, const Lanes& v, double factor, double* to) {
  const double* b = at(block);
  for (int i = 0; i < 3; ++i) {
    to[i] += factor *
             (b[kSymmetric[i][0]] * v[0] + b[kSymmetric[i][1]] * v[1] + b[kSymmetric[i][2]] * v[2]);
  }
}

// The ends are x_0 + (eta - 1) rate: their blocks go to the border, c_k += B rate, and to the
// corner, rate' A rate + 2 rate' c.
void fold_ends(SplineState& w) {
  for (int end = 0; end < 2; ++end) {
    const Lanes* rate = end == 0 ? w.start_rate : w.goal_rate;
    const KnotSums& knot = w.knots[end == 0 ? 0 : w.last];
    for (int r = 0; r < 3; ++r) {
      double product[3] = {};
      for (int c = 0; c < 3; ++c) add_product(knot.block[kDiagonal[r][c]], rate[c], 1.0, product);
      for (int i = 0; i < 3; ++i) {
        w.corner += rate[r][i] * (product[i] + 2.0 * knot.border[r][i]);
      }
    }
  }
  for (int r = 0; r < 3; ++r) {
    for (int c = 0; c < 3; ++c) {
      if (w.last == 1) {
        double product[3] = {};
        add_product(w.pieces[0].block[3 * r + c], w.start_rate[c], 1.0, product);
        for (int i = 0; i < 3; ++i) w.corner += 2.0 * w.goal_rate[r][i] * product[i];
        continue;
      }
      add_product(w.pieces[0].block[3 * r + c], w.start_rate[c], 1.0, at(w.knots[1].border + r));
      add_product(w.pieces[w.last - 1].block[3 * r + c], w.goal_rate[r], 1.0,
                  at(w.knots[w.last - 1].border + c));
    }
  }
}

bool factor(SplineState& w) {
  w.corner = w.scale ? w.hessian_eta : 1.0;
  if (w.scale && w.ends_move) fold_ends(w);
  Below below[2];
  for (int k = 1; k < w.last; ++k) {
    Panel& panel = w.panels[k];
    const PieceSums* piece = k + 1 < w.last ? &w.pieces[k] : nullptr;
    for (int c = 0; c < 3; ++c) {
      for (int axis = 0; axis < 3; ++axis) {
        expand(w.knots[k], piece, c, axis, at(panel.u[3 * c + axis]));
      }
    }
    const Panel* before = k > 1 ? &w.panels[k - 1] : nullptr;
    if (!factor_panel(panel, below[k % 2], before, below[1 - k % 2], w.corner)) return false;
  }
  return w.corner > 0.0 && w.corner < 1e300;
}

// Forward: x = D^-1 L^-1 x for the panel's nine; next and the border lose what L has below.
GOSHAWK_INLINE void solve_down(const Panel& panel, Lanes* x, Lanes* next) {
  Lanes a[3] = {x[0], x[1], x[2]};
  Lanes b[3] = {next[0], next[1], next[2]};
  a[2][1] = 0.0;
#pragma GCC unroll 9
  for (int j = 0; j < 9; ++j) {
    const double t = a[j / 4][j % 4] * at(panel.inverse_d)[j];
    at(x)[j] = t;
    const Lanes factor = all(t);
    for (int i = j / 4; i < 3; ++i) a[i] -= factor * panel.u[j][i];
    for (int i = 0; i < 3; ++i) b[i] -= factor * panel.u[j][3 + i];
  }
  at(x)[9] = a[2][1];  // what the border loses
  for (int i = 0; i < 3; ++i) next[i] = b[i];
}

// Backward: x = L^-T x for the panel's nine, next and the border known.
GOSHAWK_INLINE void solve_up(const Panel& panel, Lanes* x, const Lanes* next) {
  Lanes a[3] = {x[0], x[1], x[2]};
#pragma GCC unroll 3
  for (int g = 0; g < 3; ++g) {
    Lanes dot[4] = {};
    for (int j = 4 * g; j < 4 * g + 4 && j < 9; ++j) {
      for (int i = 0; i < 3; ++i) dot[j - 4 * g] += panel.u[j][3 + i] * next[i];
    }
    a[g] -= sums(dot[0], dot[1], dot[2], dot[3]) * panel.inverse_d[g];
  }
#pragma GCC unroll 9
  for (int j = 8; j > 0; --j) {
    const Lanes factor = all(a[j / 4][j % 4]);
    for (int i = 0; i < 2; ++i) a[i] -= factor * panel.transposed[j][i];
  }
  for (int i = 0; i < 3; ++i) x[i] = a[i];
}

// In: w.rhs (packed, inner knots) and w.deta, the right-hand side of eta. Out: dx, deta.
void solve(SplineState& w) {
  for (int i = 0; i < 3; ++i) w.rhs[3 * w.last + i] = all(0.0);
  double border = w.deta;
  for (int k = 1; k < w.last; ++k) {
    solve_down(w.panels[k], w.rhs + 3 * k, w.rhs + 3 * (k + 1));
    border += at(w.rhs + 3 * k)[9];
  }
  border = w.scale ? border / w.corner : 0.0;
  w.deta = border;
  for (int i = 0; i < 3; ++i) w.rhs[3 * w.last + i] = all(0.0);
  at(w.rhs + 3 * w.last)[9] = border;
  for (int k = w.last - 1; k > 0; --k) {
    Lanes* x = w.rhs + 3 * k;
    at(x)[9] = at(x)[10] = at(x)[11] = 0.0;
    solve_up(w.panels[k], x, w.rhs + 3 * (k + 1));
    at(x)[9] = border;
    at(x)[10] = at(x)[11] = 0.0;
    const double* from = at(x);
    for (int i = 0; i < 3; ++i) {
      w.dx[3 * k + i] = Lanes{from[3 * i], from[3 * i + 1], from[3 * i + 2], 0.0};
    }
  }
  for (int i = 0; i < 3; ++i) {
    w.dx[i] = border * w.start_rate[i];
    w.dx[3 * w.last + i] = border * w.goal_rate[i];
  }
}

// rhs = -cost - pull - extra of all knots, the ends folded into eta's.
void load_rhs(SplineState& w) {
  w.deta = w.scale ? -w.time_weight - w.pull_eta : 0.0;
  for (int k = 1; k < w.last; ++k) {
    double* to = at(w.rhs + 3 * k);
    const KnotSums& knot = w.knots[k];
    for (int b = 0; b < 3; ++b) {
      const Lanes v = -knot.cost[b] - knot.pull[b];
      for (int i = 0; i < 3; ++i) to[3 * b + i] = v[i];
    }
    to[9] = to[10] = to[11] = 0.0;
  }
  if (!w.scale || !w.ends_move) return;
  for (int b = 0; b < 3; ++b) {
    const KnotSums& first = w.knots[0];
    const KnotSums& final = w.knots[w.last];
    w.deta -= sum((first.cost[b] + first.pull[b]) * w.start_rate[b]);
    w.deta -= sum((final.cost[b] + final.pull[b]) * w.goal_rate[b]);
  }
}
