// Which constraint is violated most. Included by active_set_kernels.inl.

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

Worst price_faces(ActiveSetState& s) {
  Worst worst;
  const Lanes tolerance = all(s.face_tolerance);
  Lanes outside = all(-1e300);
  for (int p = 0; p < s.point_count; ++p) {
    const PricedPoint& point = s.points[p];
    const Lanes* v = s.x + 3 * point.joint;
    const Lanes y = point.map[0] * v[0] + point.map[1] * v[1] + point.map[2] * v[2];
    const Lanes y0 = all(y[0]), y1 = all(y[1]), y2 = all(y[2]), weight = all(point.weight);
    for (int i = point.begin; i < point.end; ++i) {
      const FourFaces& f = s.faces[i];
      const Lanes violation = f.nx * y0 + f.ny * y1 + f.nz * y2 - f.offset;
      outside = larger(outside, violation);
      consider(worst, violation > tolerance ? violation * weight : Lanes{}, i);
    }
  }
  s.face_violation = largest(outside);
  return worst;
}

GOSHAWK_INLINE void limit_points(const PricedLimits& l, const Lanes* x, Lanes* y) {
  // Lane by lane of y: the components of four points. x holds one joint's components a vector.
  for (int c = 0; c < 3; ++c) {
    y[c] = l.map[0] * x[0][c] + l.map[1] * x[1][c] + l.map[2] * x[2][c] + l.map[3] * x[3][c] +
           l.map[4] * x[4][c] + l.map[5] * x[5][c];
  }
}

// Index of a norm of the points of a piece: derivative, piece, norm.
GOSHAWK_INLINE long long limit_index(int derivative, int piece, int norm) {
  return ((long long)(piece)*kDerivatives + derivative) * kMostNorms + norm;
}

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
      for (int r = 0; r < set.norms; ++r) {
        const double* w = set.weights[r];
        const Lanes q = w[0] * y[0] * y[0] + w[1] * y[1] * y[1] + w[2] * y[2] * y[2];
        outside = larger(outside, q - one);
        const Lanes violation = root(q) - one;
        consider(worst, q - one > tolerance ? violation * set.pieces[k].weight : Lanes{},
                 limit_index(d, k, r));
      }
    }
  }
  s.limit_violation = largest(outside);
  return worst;
}

void take_face(ActiveSetState& s, long long index, int lane) {
  const FourFaces& f = s.faces[index];
  const PricedPoint* point = s.points;
  while (point->end <= index) ++point;
  HalfSpace& to = s.next;
  to.normal = Lanes{f.nx[lane], f.ny[lane], f.nz[lane], 0.0};
  to.bound = f.offset[lane];
  to.limit = -1;
  to.joint = point->joint;
  for (int b = 0; b < 3; ++b) {
    to.map[b] = point->map[b];
    to.map[b + 3] = 0.0;
  }
}

// The half-space that touches the limit in the direction of the point. Where the norm is of one
// component, that is the limit itself.
void take_limit(ActiveSetState& s, long long index, int lane) {
  const int norm = int(index % kMostNorms);
  const int derivative = int(index / kMostNorms % kDerivatives);
  const int piece = int(index / kMostNorms / kDerivatives);
  const PricedSet& set = s.limits[derivative];
  const PricedLimits& l = set.pieces[piece];
  HalfSpace& to = s.next;
  to.joint = piece;
  for (int b = 0; b < 6; ++b) to.map[b] = l.map[b][lane];
  const Lanes y = point_at(s.x, piece, to.map);
  const double* w = set.weights[norm];
  const Lanes direction = {w[0] * y[0], w[1] * y[1], w[2] * y[2], 0.0};
  to.normal = direction / all(__builtin_sqrt(sum(direction * y)));
  to.bound = 1.0;
  const int components = (w[0] > 0.0) + (w[1] > 0.0) + (w[2] > 0.0);
  to.limit = components > 1 ? 4 * index + lane : -1;
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
  s.violation = sum(s.next.normal * point_at(s.x, s.next.joint, s.next.map)) - s.next.bound;
}
