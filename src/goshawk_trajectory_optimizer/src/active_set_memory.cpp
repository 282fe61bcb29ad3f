#include "active_set_memory.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace goshawk::trajectory_optimizer {
namespace {

constexpr int kMostActive = 72;  // what more of them cost, the interior point does not

Lanes four_of(const Vec3& v) {
  return Lanes{v[0], v[1], v[2], 0.0};
}

// The control points of a piece have the faces of one polytope.
bool same_faces(const SplineProblem& problem, const FacePoint& a, const FacePoint& b) {
  const int count = a.end - a.begin;
  const HalfSpace* faces = problem.faces.data();
  return b.end - b.begin == count &&
         std::memcmp(faces + a.begin, faces + b.begin, std::size_t(count) * sizeof(HalfSpace)) == 0;
}

double* doubles_of(Lanes& first) {
  return reinterpret_cast<double*>(&first);
}

// @param vertical the horizontal limit over the vertical one
void set_norms(PricedSet& set, LimitNorm norm, double vertical) {
  for (auto& weights : set.weights) std::fill(std::begin(weights), std::end(weights), 0.0);
  const bool euclidean = norm == LimitNorm::euclidean;
  set.norms = euclidean ? 1 : norm == LimitNorm::per_axis ? 3 : 2;
  for (int c = 0; c < 3; ++c) {
    const int n = std::min(c, set.norms - 1);
    set.weights[set.norms == 2 && c < 2 ? 0 : n][c] = 1.0;
  }
  if (set.norms == 2) set.weights[1][2] = vertical * vertical;
}

PointMap derivative_point(int derivative, int j, double T) {
  return derivative == 0   ? velocity_point(j, T)
         : derivative == 1 ? acceleration_point(j, T)
                           : jerk_point(j, T);
}

}  // namespace

void ActiveSetSolver::Memory::load(const SplineProblem& problem) {
  state = ActiveSetState();
  state.last = problem.pieces();
  finite = true;
  constant_violated = false;
  load_knots(problem);
  load_faces(problem);
  load_limits(problem);
  reserve_working_set();
}

void ActiveSetSolver::Memory::load_knots(const SplineProblem& problem) {
  const std::size_t n = std::size_t(state.last) + 1;
  for (auto* v : {&x_, &free_, &work_, &residual_}) v->assign(3 * n, Four{});
  factors_.resize(n);
  jerk_.resize(n);
  for (std::size_t k = 0; k < n; ++k) {
    const Knot& knot = problem.knots[k];
    for (int b = 0; b < 3; ++b) x_[3 * k + std::size_t(b)].v = four_of(knot.col(b));
  }
  finite = problem.knots.front().allFinite() && problem.knots.back().allFinite();
  for (std::size_t k = 0; k + 1 < n; ++k) {
    Eigen::Map<Eigen::Matrix<double, 6, 6>>(jerk_[k].q) =
        problem.jerk_weight * jerk_hessian(problem.durations[k]);
  }
  state.x = &x_[0].v;
  state.free = &free_[0].v;
  state.work = &work_[0].v;
  state.residual = &residual_[0].v;
  state.jerk = jerk_[0].q;
  state.factors = factors_.data();
}

void ActiveSetSolver::Memory::load_faces(const SplineProblem& problem) {
  points_.clear();
  faces_.clear();
  const FacePoint* packed = nullptr;  // whose faces were packed last
  for (const FacePoint& point : problem.face_points) {
    if (point.knot <= 0 || point.knot >= state.last) {
      check_constant(problem, point);
      continue;
    }
    if (packed == nullptr || !same_faces(problem, *packed, point)) {
      first_packed_ = int(faces_.size());
      pack_faces(problem, point);
      packed = &point;
    }
    PricedPoint& to = points_.emplace_back();
    to = {point.knot, first_packed_, int(faces_.size()), {}, 0.0};
    for (int i = 0; i < 3; ++i) to.map[i] = point.map[i];
  }
  state.points = points_.data();
  state.point_count = int(points_.size());
  state.faces = faces_.data();
}

void ActiveSetSolver::Memory::pack_faces(const SplineProblem& problem, const FacePoint& point) {
  double probe = 0.0;  // not zero if anything is not finite
  for (int i = point.begin; i < point.end; ++i) {
    const HalfSpace& face = problem.faces[std::size_t(i)];
    probe += 0.0 * (face.normal[0] + face.normal[1] + face.normal[2] + face.offset_m);
    const int lane = (i - point.begin) % 4;
    if (lane == 0) faces_.push_back({Lanes{}, Lanes{}, Lanes{}, Lanes{1.0, 1.0, 1.0, 1.0}});
    FourFaces& four = faces_.back();
    four.nx[lane] = face.normal[0];
    four.ny[lane] = face.normal[1];
    four.nz[lane] = face.normal[2];
    four.offset[lane] = face.offset_m;
  }
  finite = finite && probe == 0.0;
}

void ActiveSetSolver::Memory::check_constant(const SplineProblem& problem, const FacePoint& point) {
  const Vec3 y = problem.knots[std::size_t(point.knot)] * point.map;
  for (int i = point.begin; i < point.end; ++i) {
    const HalfSpace& face = problem.faces[std::size_t(i)];
    if (!(face.normal.dot(y) <= face.offset_m)) constant_violated = true;
  }
}

void ActiveSetSolver::Memory::load_limits(const SplineProblem& problem) {
  set_norms(state.limits[0], problem.norm, problem.v_over_vertical);
  set_norms(state.limits[1], problem.norm, problem.a_over_vertical);
  set_norms(state.limits[2], LimitNorm::euclidean, 1.0);
  const int derivatives = problem.j_max.empty() ? 2 : 3;
  for (int d = 0; d < derivatives; ++d) {
    auto& pieces = limits_[d];
    pieces.assign(std::size_t(state.last), PricedLimits{});
    for (int k = 0; k < state.last; ++k) load_limit(problem, k, d, pieces[std::size_t(k)]);
    state.limits[d].pieces = pieces.data();
  }
  // Jerk points are differences of acceleration points: |j| <= 6 a_max / T, on each of three axes.
  const double vertical = problem.norm == LimitNorm::horizontal_vertical
                              ? std::max(1.0, 1.0 / problem.a_over_vertical)
                              : 1.0;
  most_objective = 0.0;
  for (std::size_t k = 0; k < problem.durations.size(); ++k) {
    const double T = problem.durations[k];
    const double jerk = 6.0 * vertical * problem.a_max[k] / T;
    most_objective += 0.5 * problem.jerk_weight * T * 3.0 * jerk * jerk;
  }
}

void ActiveSetSolver::Memory::load_limit(const SplineProblem& problem, int k, int derivative,
                                         PricedLimits& to) {
  const auto i = std::size_t(k);
  const double T = problem.durations[i];
  const auto& limits = derivative == 0   ? problem.v_max
                       : derivative == 1 ? problem.a_max
                                         : problem.j_max;
  // Control points of neighbouring pieces coincide at a knot: one limit, the tighter.
  const int first = k > 0 || derivative == 2 ? 0 : 1;
  const int end = derivative == 0 ? 4 : 3;
  for (int j = first; j < end; ++j) {
    const PointMap map = derivative_point(derivative, j, T);
    const bool shared = j == 0 && derivative < 2;
    const double limit = shared ? std::min(limits[i - 1], limits[i]) : limits[i];
    if (check_constant(map, k, limit, state.limits[derivative])) continue;
    for (int b = 0; b < 3; ++b) {
      to.map[b][j] = map.from_first[b] / limit;
      to.map[b + 3][j] = map.from_second[b] / limit;
    }
  }
}

// @return whether no unknown moves the point; then it is checked, once and for all
bool ActiveSetSolver::Memory::check_constant(const PointMap& map, int k, double limit,
                                             const PricedSet& set) {
  const bool first = k > 0 && !map.from_first.isZero(0.0);
  const bool second = k + 1 < state.last && !map.from_second.isZero(0.0);
  if (first || second) return false;
  const Vec3 y = map(knot(k), knot(k + 1));
  for (int r = 0; r < set.norms; ++r) {
    double square = 0.0;
    for (int c = 0; c < 3; ++c) square += set.weights[r][c] * y[c] * y[c];
    if (!(std::sqrt(square) <= limit * (1.0 + 1e-9))) constant_violated = true;
  }
  return true;
}

void ActiveSetSolver::Memory::reserve_working_set() {
  const int unknowns = 9 * std::max(0, state.last - 1);
  state.capacity = std::min(unknowns, kMostActive);
  const std::size_t fours = std::size_t(state.capacity) / 4 + 1;
  state.stride = 4 * int(fours);
  if (root_.size() < 4 * fours * fours) root_.resize(4 * fours * fours);
  for (auto* v : {&column_, &image_, &change_}) {
    if (v->size() < fours) v->resize(fours);
  }
  if (active_.size() < std::size_t(state.capacity)) active_.resize(std::size_t(state.capacity));
  state.inverse_root = doubles_of(root_[0].v);
  state.column = doubles_of(column_[0].v);
  state.image = doubles_of(image_[0].v);
  state.change = doubles_of(change_[0].v);
  state.active = active_.data();
}

Knot ActiveSetSolver::Memory::knot(int k) const {
  Knot knot;
  for (int b = 0; b < 3; ++b) {
    const Lanes& v = x_[std::size_t(3 * k + b)].v;
    knot.col(b) = Vec3(v[0], v[1], v[2]);
  }
  return knot;
}

}  // namespace goshawk::trajectory_optimizer
