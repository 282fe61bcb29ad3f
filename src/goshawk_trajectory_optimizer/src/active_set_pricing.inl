// Pricing: the constraint with the largest violation * weight, weight = 1 / sqrt(a' H^-1 a).
// Included by active_set_kernels.inl.

// The largest weighted violation of each lane, and where it is.
struct Worst {
  Lanes score = {};
  LaneIndices index = {};
};

GOSHAWK_INLINE void consider(Worst& worst, Lanes score, long long index) {
  const LaneIndices here = {index, index, index, index};
  const auto more = score > worst.score;
  worst.score = more ? score : worst.score;
  worst.index = more ? here : worst.index;
}

// The first of the largest. @return its score
GOSHAWK_INLINE double winner(const Worst& worst, long long& index, int& lane) {
  double best = 0.0;
  for (int i = 0; i < 4; ++i) {
    const bool more =
        worst.score[i] > best || (worst.score[i] == best && best > 0.0 && worst.index[i] < index);
    if (!more) continue;
    best = worst.score[i];
    index = worst.index[i];
    lane = i;
  }
  return best;
}

GOSHAWK_INLINE Lanes root(Lanes q) {
  return Lanes{__builtin_sqrt(q[0]), __builtin_sqrt(q[1]), __builtin_sqrt(q[2]),
               __builtin_sqrt(q[3])};
}

// n . y - offset
GOSHAWK_INLINE Lanes violation_of(const FourFaces& f, Lanes y0, Lanes y1, Lanes y2) {
  return f.nx * y0 + f.ny * y1 + f.nz * y2 - f.offset;
}

GOSHAWK_INLINE Lanes face_point(const ActiveSetState& s, const PricedPoint& point) {
  const Lanes* v = s.x + 3 * point.knot;
  return point.map[0] * v[0] + point.map[1] * v[1] + point.map[2] * v[2];
}

// The point with the most violated face, and face_violation = max n . y - offset. Which of its faces
// it is take_face() finds, for the winner only.
Worst price_faces(ActiveSetState& s) {
  Worst worst;
  const Lanes tolerance = all(s.face_tolerance);
  Lanes outside = all(-1e300);
  for (int p = 0; p < s.point_count; ++p) {
    const PricedPoint& point = s.points[p];
    const Lanes y = face_point(s, point);
    const Lanes y0 = all(y[0]), y1 = all(y[1]), y2 = all(y[2]);
    Lanes violation = all(-1e300);
    for (int i = point.begin; i < point.end; ++i) {
      violation = larger(violation_of(s.faces[i], y0, y1, y2), violation);
    }
    outside = larger(outside, violation);
    consider(worst, violation > tolerance ? violation * point.weight : Lanes{}, p);
  }
  s.face_violation = largest(outside);
  return worst;
}

GOSHAWK_INLINE void limit_points(const PricedLimits& l, const Lanes* x, Lanes* y) {
  // y[c]: component c of four points, one a lane. x[i]: the components of one state of a knot.
  for (int c = 0; c < 3; ++c) {
    y[c] = l.map[0] * x[0][c] + l.map[1] * x[1][c] + l.map[2] * x[2][c] + l.map[3] * x[3][c] +
           l.map[4] * x[4][c] + l.map[5] * x[5][c];
  }
}

// max over norms r of sum_c weight_rc y_c^2, one point a lane
GOSHAWK_INLINE Lanes largest_square(const PricedSet& set, const Lanes* y) {
  Lanes largest = {};
  for (int r = 0; r < set.norms; ++r) {
    const double* w = set.weights[r];
    largest = larger(largest, w[0] * y[0] * y[0] + w[1] * y[1] * y[1] + w[2] * y[2] * y[2]);
  }
  return largest;
}

// The point with the largest (|y| - 1) weight, and limit_violation = max |y|^2 - 1.
Worst price_limits(ActiveSetState& s) {
  Worst worst;
  const Lanes one = all(1.0), tolerance = all(s.limit_tolerance);
  Lanes outside = all(-1.0);
  for (int k = 0; k < s.last; ++k) {
    for (int d = 0; d < kDerivatives; ++d) {
      const PricedSet& set = s.limits[d];
      if (set.pieces == nullptr) continue;
      Lanes y[3];
      limit_points(set.pieces[k], s.x + 3 * k, y);
      const Lanes square = largest_square(set, y);
      const Lanes over = square - one;
      outside = larger(outside, over);
      if (!(largest(over) > s.limit_tolerance)) continue;
      const Lanes violation = root(square) - one;
      consider(worst, over > tolerance ? violation * set.pieces[k].weight : Lanes{},
               (long long)(k)*kDerivatives + d);
    }
  }
  s.limit_violation = largest(outside);
  return worst;
}

// next = the most violated face of a point
void take_face(ActiveSetState& s, long long index, int lane) {
  const PricedPoint& point = s.points[index];
  const Lanes y = face_point(s, point);
  int most = point.begin;
  double violation = -1e300;
  for (int i = point.begin; i < point.end; ++i) {
    const double here = violation_of(s.faces[i], all(y[0]), all(y[1]), all(y[2]))[lane];
    if (here > violation) most = i;
    violation = larger(here, violation);
  }
  const FourFaces& f = s.faces[most];
  Constraint& to = s.next;
  to.normal = Lanes{f.nx[lane], f.ny[lane], f.nz[lane], 0.0};
  to.bound = f.offset[lane];
  to.limit = -1;
  to.knot = point.knot;
  for (int b = 0; b < 3; ++b) {
    to.map[b] = point.map[b];
    to.map[b + 3] = 0.0;
  }
}

// next = the half-space that touches the limit in the direction of the point: W y / |y| . y' <= 1, W
// the norm's weights. If the norm has one component, that is the limit itself.
void take_limit(ActiveSetState& s, long long index, int lane) {
  const int derivative = int(index % kDerivatives);
  const int piece = int(index / kDerivatives);
  const PricedSet& set = s.limits[derivative];
  const PricedLimits& l = set.pieces[piece];
  Constraint& to = s.next;
  to.knot = piece;
  for (int b = 0; b < 6; ++b) to.map[b] = l.map[b][lane];
  const Lanes y = point_at(s.x, piece, to.map);
  int norm = 0;
  double square = 0.0;
  for (int r = 0; r < set.norms; ++r) {
    const double* w = set.weights[r];
    const double here = w[0] * y[0] * y[0] + w[1] * y[1] * y[1] + w[2] * y[2] * y[2];
    if (here > square) norm = r;
    square = larger(here, square);
  }
  const double* w = set.weights[norm];
  const Lanes direction = {w[0] * y[0], w[1] * y[1], w[2] * y[2], 0.0};
  to.normal = direction / all(__builtin_sqrt(square));
  to.bound = 1.0;
  const int components = (w[0] > 0.0) + (w[1] > 0.0) + (w[2] > 0.0);
  to.limit = components > 1 ? (4 * index + lane) * kMostNorms + norm : -1;
}

void price(ActiveSetState& s) {
  long long face = 0, limit = 0;
  int face_lane = 0, limit_lane = 0;
  const double of_faces = winner(price_faces(s), face, face_lane);
  const double of_limits = winner(price_limits(s), limit, limit_lane);
  s.violation = 0.0;
  if (!(of_faces > 0.0) && !(of_limits > 0.0)) return;
  if (of_faces >= of_limits) {
    take_face(s, face, face_lane);
  } else {
    take_limit(s, limit, limit_lane);
  }
  s.next.multiplier = 0.0;
  // The sum is taken in another order than above: it must stay a violation.
  const Lanes y = point_at(s.x, s.next.knot, s.next.map);
  s.violation = larger(sum(s.next.normal * y) - s.next.bound, 1e-300);
}
