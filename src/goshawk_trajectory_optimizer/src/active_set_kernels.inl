// The steps of the dual active-set method over an ActiveSetState. Included by one source for each
// instruction set, inside an unnamed namespace: nothing here may be shared between them.
//
// The problem is: minimise 1/2 x' H x + h' x subject to a_i' x <= b_i. For a working set W of
// constraints that hold with equality, rows of A, multipliers u >= 0:
//
//   x = free - H^-1 A' u,   free = -H^-1 h,   M' M = (A H^-1 A')^-1
//
// As the multiplier of one more constraint a grows by t, those of W change by -t change with
// change = M' M A H^-1 a, and its violation by -t slope with slope = a' H^-1 (a - A' change).

#include "active_set_factor.inl"
#include "active_set_pricing.inl"

// work = H^-1 work = L'^-1 D^-1 L^-1 work, which is zero before knot `from`.
void solve(ActiveSetState& s, int from) {
  for (int k = from + 1; k < s.last; ++k) {
    Lanes* v = s.work + 3 * k;
    const double* l = s.factors[k].below;
    for (int i = 0; i < 3; ++i) {
      v[i] = v[i] - l[3 * i] * v[-3] - l[3 * i + 1] * v[-2] - l[3 * i + 2] * v[-1];
    }
  }
  for (int k = s.last - 1; k >= 1; --k) {
    Lanes* v = s.work + 3 * k;
    const double* d = s.factors[k].inverse;
    const Lanes a = v[0], b = v[1], c = v[2];
    for (int i = 0; i < 3; ++i) v[i] = d[3 * i] * a + d[3 * i + 1] * b + d[3 * i + 2] * c;
    if (k + 1 == s.last) continue;
    const double* l = s.factors[k + 1].below;
    for (int i = 0; i < 3; ++i) v[i] = v[i] - l[i] * v[3] - l[3 + i] * v[4] - l[6 + i] * v[5];
  }
}

GOSHAWK_INLINE void clear_work(ActiveSetState& s) {
  for (int i = 0; i < 3 * (s.last + 1); ++i) s.work[i] = Lanes{};
}

// work += factor * the gradient of a constraint
GOSHAWK_INLINE void scatter(ActiveSetState& s, const Constraint& a, double factor) {
  Lanes* v = s.work + 3 * a.knot;
  const Lanes n = factor * a.normal;
  for (int b = 0; b < 6; ++b) v[b] += a.map[b] * n;
}

// The ends do not move.
GOSHAWK_INLINE void hold_ends(ActiveSetState& s) {
  for (int b = 0; b < 3; ++b) s.work[b] = s.work[3 * s.last + b] = Lanes{};
}

// work = H^-1 A' multipliers: how far the constraints hold x back
void pull_back(ActiveSetState& s) {
  clear_work(s);
  for (int i = 0; i < s.count; ++i) scatter(s, s.active[i], s.active[i].multiplier);
  hold_ends(s);
  solve(s, 1);
}

// x = free - H^-1 A' u
void place(ActiveSetState& s) {
  pull_back(s);
  for (int i = 0; i < 3 * (s.last + 1); ++i) s.x[i] = s.free[i] - s.work[i];
}

// own = a' H^-1 a and column = A H^-1 a of the next constraint
void reach(ActiveSetState& s) {
  clear_work(s);
  scatter(s, s.next, 1.0);
  hold_ends(s);
  solve(s, s.next.knot > 0 ? s.next.knot : 1);
  s.own = sum(s.next.normal * point_at(s.work, s.next.knot, s.next.map));
  for (int i = 0; i < s.count; ++i) {
    const Constraint& a = s.active[i];
    s.column[i] = sum(a.normal * point_at(s.work, a.knot, a.map));
  }
}

GOSHAWK_INLINE Lanes* lanes_of(double* v) {
  return reinterpret_cast<Lanes*>(v);
}

// to = M from
GOSHAWK_INLINE void multiply(const ActiveSetState& s, const double* from, double* to) {
  const int width = (s.count + 3) / 4;
  for (int i = 0; i < s.count; i += 4) {
    const double* row = s.inverse_root + i * s.stride;
    Lanes a[4] = {};
    for (int j = 0; j < width; ++j) {
      const Lanes v = reinterpret_cast<const Lanes*>(from)[j];
      for (int r = 0; r < 4; ++r) {
        a[r] += reinterpret_cast<const Lanes*>(row + r * s.stride)[j] * v;
      }
    }
    lanes_of(to + i)[0] = sums(a[0], a[1], a[2], a[3]);
  }
}

// to = M' from
GOSHAWK_INLINE void multiply_transposed(const ActiveSetState& s, const double* from, double* to) {
  const int width = (s.count + 3) / 4;
  for (int j = 0; j < width; ++j) lanes_of(to)[j] = Lanes{};
  for (int i = 0; i < s.count; ++i) {
    const auto* row = reinterpret_cast<const Lanes*>(s.inverse_root + i * s.stride);
    for (int j = 0; j < width; ++j) lanes_of(to)[j] += from[i] * row[j];
  }
}

// A small slope is rounding if computed as a difference. With the remainder e = a - A' change it is
// e' H^-1 e; remainder = |e|_1 proves infeasibility.
void measure_remainder(ActiveSetState& s) {
  clear_work(s);
  scatter(s, s.next, 1.0);
  for (int i = 0; i < s.count; ++i) scatter(s, s.active[i], -s.change[i]);
  hold_ends(s);
  Lanes total = {};
  for (int i = 3; i < 3 * s.last; ++i) total += magnitude(s.work[i]);
  s.remainder = sum(total);
  solve(s, 1);
  s.slope = sum(s.next.normal * point_at(s.work, s.next.knot, s.next.map));
  for (int i = 0; i < s.count; ++i) {
    const Constraint& a = s.active[i];
    s.slope -= s.change[i] * sum(a.normal * point_at(s.work, a.knot, a.map));
  }
}

// image = M column, change = M' image, slope = own - |image|^2
void project(ActiveSetState& s) {
  constexpr double kCancelled = 1e-6;
  for (int i = s.count; i % 4 != 0; ++i) s.column[i] = 0.0;
  multiply(s, s.column, s.image);
  double square = 0.0;
  for (int i = 0; i < s.count; ++i) square += s.image[i] * s.image[i];
  multiply_transposed(s, s.image, s.change);
  s.slope = s.own - square;
  s.remainder = 1e300;
  if (s.slope < kCancelled * s.own) measure_remainder(s);
}

// The next constraint cuts a ball that is active already: its point y has slid along the half-spaces
// that touch the ball. At the optimum the force F = sum u n has the direction of y. As F turns by an
// angle, y turns by slope |F| times as much the other way, slope being that of the direction across.
// Newton's step from F's direction towards y's is therefore 1 / (1 + |F| slope) of the way.
void turn(ActiveSetState& s) {
  if (s.next.limit < 0) return;
  Lanes pull = {};
  for (int i = 0; i < s.count; ++i) {
    const Constraint& a = s.active[i];
    if (a.limit == s.next.limit) pull += a.multiplier * a.normal;
  }
  const double force = __builtin_sqrt(sum(pull * pull));
  if (!(force > 0.0)) return;
  ++s.turns;
  const Lanes from = pull / all(force), to = s.next.normal;
  const Lanes across = to - sum(to * from) * from;
  const double angle = __builtin_sqrt(sum(across * across));
  if (!(angle > 1e-9)) return;
  s.next.normal = across / all(angle);
  reach(s);
  project(s);
  const double share = 1.0 / (1.0 + force * larger(0.0, s.slope));
  Lanes normal = from + share * (to - from);
  normal = normal / all(__builtin_sqrt(sum(normal * normal)));
  const Lanes y = point_at(s.x, s.next.knot, s.next.map);
  const double violation = sum(normal * y) - 1.0;
  s.next.normal = to;
  if (!(violation > 0.1 * s.violation)) return;
  s.next.normal = normal;
  s.violation = violation;
}

// M of one more constraint, from the inverse of a bordered matrix: the new row of M is
// (-change, 1) / sqrt(slope).
void append(ActiveSetState& s) {
  const int k = s.count;
  double* row = s.inverse_root + k * s.stride;
  if (k % 4 == 0) {  // rows are used by fours
    for (int j = 0; j < s.stride; ++j) lanes_of(row)[j] = Lanes{};
  }
  const double inverse = 1.0 / __builtin_sqrt(s.slope);
  for (int i = 0; i < k; ++i) row[i] = -inverse * s.change[i];
  row[k] = inverse;
  s.active[k] = s.next;
  s.cuts += s.next.limit >= 0;
  ++s.count;
}

// M of one constraint less. A Householder reflection of M's rows, M - 2 v (v' M) / v' v, brings the
// column of the constraint to the last row alone; without that row and column, M is that of the
// other constraints. The last constraint takes the place of the dropped one.
void drop(ActiveSetState& s, int index) {
  const int k = s.count, final = k - 1;
  double square = 0.0;
  for (int i = 0; i < k; ++i) {
    s.image[i] = s.inverse_root[i * s.stride + index];
    square += s.image[i] * s.image[i];
  }
  s.image[final] += s.image[final] < 0.0 ? -__builtin_sqrt(square) : __builtin_sqrt(square);
  square = 0.0;
  for (int i = 0; i < k; ++i) square += s.image[i] * s.image[i];
  multiply_transposed(s, s.image, s.change);
  const double twice = 2.0 / square;
  const int width = (k + 3) / 4;
  for (int i = 0; i < final; ++i) {
    double* row = s.inverse_root + i * s.stride;
    const double factor = twice * s.image[i];
    for (int j = 0; j < width; ++j) lanes_of(row)[j] -= factor * lanes_of(s.change)[j];
    row[index] = row[final];
    row[final] = 0.0;
  }
  for (int j = 0; j < width; ++j) lanes_of(s.inverse_root + final * s.stride)[j] = Lanes{};
  s.cuts -= s.active[index].limit >= 0;
  s.active[index] = s.active[final];
  s.column[index] = s.column[final];
  --s.count;
}

// u += M' M (A x - b), not below zero: what the active constraints miss. change = by how much.
void refine(ActiveSetState& s) {
  for (int i = 0; i < s.count; ++i) {
    const Constraint& a = s.active[i];
    s.column[i] = sum(a.normal * point_at(s.x, a.knot, a.map)) - a.bound;
  }
  for (int i = s.count; i % 4 != 0; ++i) s.column[i] = 0.0;
  multiply(s, s.column, s.image);
  multiply_transposed(s, s.image, s.change);
  for (int i = 0; i < s.count; ++i) {
    const double before = s.active[i].multiplier;
    s.active[i].multiplier = larger(0.0, before + s.change[i]);
    s.change[i] = s.active[i].multiplier - before;
  }
}

// objective = 1/2 x' Q x over the pieces, residual = its gradient.
// @return the gradient's largest component, at least 1
GOSHAWK_INLINE double differentiate_cost(ActiveSetState& s) {
  Lanes size = all(1.0), cost = {};
  for (int i = 0; i < 3 * (s.last + 1); ++i) s.residual[i] = Lanes{};
  for (int k = 0; k < s.last; ++k) {
    const double* q = s.jerk + 36 * k;
    const Lanes* x = s.x + 3 * k;
    for (int b = 0; b < 6; ++b) {
      Lanes g = {};
      for (int c = 0; c < 6; ++c) g += q[6 * b + c] * x[c];
      cost += g * x[b];
      s.residual[3 * k + b] += g;
    }
  }
  s.objective = 0.5 * sum(cost);
  for (int i = 3; i < 3 * s.last; ++i) size = larger(size, magnitude(s.residual[i]));
  return largest(size);
}

// From x and the multipliers alone: residual r = gradient of the cost + A' u, dual_residual its
// largest component, relative, and gap = sum u |b - a' x| + r' H^-1 r / 2, for the Lagrangian's least
// value is r' H^-1 r / 2 below its value at x. Leaves H^-1 r in work.
void measure(ActiveSetState& s) {
  const double size = differentiate_cost(s);
  s.gap = 0.0;
  for (int i = 0; i < s.count; ++i) {
    const Constraint& a = s.active[i];
    Lanes* v = s.residual + 3 * a.knot;
    for (int b = 0; b < 6; ++b) v[b] += a.map[b] * (a.multiplier * a.normal);
    const double slack = a.bound - sum(a.normal * point_at(s.x, a.knot, a.map));
    s.gap += a.multiplier * larger(slack, -slack);
  }
  Lanes residual = {}, product = {};
  clear_work(s);
  for (int i = 3; i < 3 * s.last; ++i) {
    residual = larger(residual, magnitude(s.residual[i]));
    s.work[i] = s.residual[i];
  }
  solve(s, 1);
  for (int i = 3; i < 3 * s.last; ++i) product += s.work[i] * s.residual[i];
  s.dual_residual = largest(residual) / size;
  s.gap += 0.5 * larger(0.0, sum(product));
}

// A step of iterative refinement after measure(), for very uneven durations, which leave rounding:
// x -= H^-1 r, u and x by refine(), and free = x + H^-1 A' u so that place() gives this x again.
void polish(ActiveSetState& s) {
  const auto step = [&] {
    for (int i = 3; i < 3 * s.last; ++i) s.x[i] -= s.work[i];
  };
  step();
  refine(s);
  clear_work(s);
  for (int i = 0; i < s.count; ++i) scatter(s, s.active[i], s.change[i]);
  hold_ends(s);
  solve(s, 1);
  step();
  pull_back(s);
  for (int i = 3; i < 3 * s.last; ++i) s.free[i] = s.x[i] + s.work[i];
}
