#include "spline_memory.hpp"

// What the durations of the pieces are worth, by the multipliers of a solution.
namespace goshawk::trajectory_optimizer {
namespace {

// A control point is y = sum_b m_b x_b, and m_b a power of the duration T: of its logarithm it is
// a linear function, sum_b power_b m_b x_b.
double faces_slope(const SplineState& s, const FaceRange& range) {
  const Lanes* x = s.x + 3 * range.knot;
  const Lanes dy = range.map[1] * x[1] + 2.0 * range.map[2] * x[2];
  Lanes slope = {};
  const FourFaces* n = s.planes + range.planes;
  for (int i = range.begin; i < range.end; ++i, ++n) {
    slope += s.faces[i].z * (n->nx * dy[0] + n->ny * dy[1] + n->nz * dy[2]);
  }
  return slope[0] + slope[1] + slope[2] + slope[3];
}

double limits_slope(const LimitSet& set, int order, int piece, double eta, const Lanes* x) {
  const LimitLanes& l = set.lanes[piece];
  Lanes y[3] = {}, dy[3] = {};
  for (int i = 0; i < 6; ++i) {
    for (int c = 0; c < 3; ++c) {
      const Lanes part = l.map[i] * x[i][c];
      y[c] += part;
      dy[c] += double(i % 3 - order) * part;
    }
  }
  Lanes slope = {};
  for (int r = 0; r < set.rows; ++r) {
    Lanes square = {};
    for (int c = 0; c < 3; ++c) square += set.weights[r][c] * y[c] * dy[c];
    slope += 2.0 * l.row[r].z * square;
  }
  if (order > 1) slope /= l.e1 * eta + l.e0;
  return slope[0] + slope[1] + slope[2] + slope[3];
}

double jerk_slope(const double* q, const Lanes* x) {
  double slope = 0.0;
  for (int b = 0; b < 6; ++b) {
    for (int c = 0; c < 6; ++c) {
      const Lanes square = x[b] * x[c];
      slope += 0.5 * (b % 3 + c % 3 - 5) * q[6 * b + c] * (square[0] + square[1] + square[2]);
    }
  }
  return slope;
}

}  // namespace

void SplineSolver::time_slopes(std::vector<double>& slopes) const {
  const SplineState& s = memory_->state;
  slopes.assign(std::size_t(s.last), 0.0);
  for (int p = 0; p < s.face_points; ++p) {
    const FaceRange& range = s.ranges[p];
    // The points c1 and c2 of a piece move with its first knot's velocity, c3 and c4 against its
    // second's.
    const int piece = range.map[1] > 0.0 ? range.knot : range.knot - 1;
    if (range.map[1] == 0.0) continue;
    slopes[std::size_t(piece)] += faces_slope(s, range);
  }
  for (int k = 0; k < s.last; ++k) {
    const Lanes* x = s.x + 3 * k;
    double& slope = slopes[std::size_t(k)];
    slope += jerk_slope(s.jerk + 36 * k, x);
    slope += limits_slope(s.velocity, 1, k, s.eta, x);
    slope += limits_slope(s.acceleration, 2, k, s.eta, x);
    if (s.jerk_limit.lanes != nullptr) slope += limits_slope(s.jerk_limit, 3, k, s.eta, x);
  }
}

}  // namespace goshawk::trajectory_optimizer
