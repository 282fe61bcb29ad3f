#include "spline_memory.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace goshawk::trajectory_optimizer {
namespace {

constexpr double kStartMargin = 0.1;  // of the first slacks, in the problem's units
constexpr double kPull = 1.0;         // to the guess, beside the weight of the jerk
// The first duality gap in objectives of the guess. With fixed durations the objective is all
// jerk, and the constraints raise it many times over.
constexpr double kFirstGap = 2.0;
constexpr double kFarOff = 10.0;  // squared limits: enough room for the first time scale
constexpr double kFirstGapFixed = 300.0;

Lanes padded(const Vec3& v) {
  return Lanes{v[0], v[1], v[2], 0.0};
}

}  // namespace

void SplineSolver::Memory::load(const SplineProblem& problem) {
  state.last = problem.pieces();
  state.scale = problem.scale;
  state.time_weight = problem.scale ? problem.time_weight : 0.0;
  state.eta = 1.0;
  state.step = 0.0;
  jerk_weight_ = problem.jerk_weight;
  constant_point_violated = false;
  load_knots(problem);
  load_faces(problem);
  load_limits(problem);
  state.knots = knots_.data();
  state.pieces = pieces_.data();
  state.panels = panels_.data();
}

void SplineSolver::Memory::load_knots(const SplineProblem& problem) {
  const std::size_t n = std::size_t(state.last) + 1;
  for (auto* v : {&x_, &dx_, &rhs_}) v->assign(n, Triple{});
  rates_.assign(2, Triple{});
  knots_.resize(n);
  pieces_.resize(n);
  panels_.resize(n);  // what a factorisation leaves as it was stays zero
  jerk_.resize(n);
  set_knots(problem.knots);
  if (state.scale) {
    for (int b = 0; b < 3; ++b) {
      rates_[0].v[b] = padded(problem.start_rate.col(b));
      rates_[1].v[b] = padded(problem.goal_rate.col(b));
    }
  }
  state.ends_move =
      state.scale && !(problem.start_rate.isZero(0.0) && problem.goal_rate.isZero(0.0));
  for (std::size_t k = 0; k + 1 < n; ++k) {
    Eigen::Map<Eigen::Matrix<double, 6, 6>>(jerk_[k].q) =
        problem.jerk_weight * jerk_hessian(problem.durations[k]);
  }
  state.x = x_[0].v;
  state.dx = dx_[0].v;
  state.rhs = rhs_[0].v;
  state.start_rate = rates_[0].v;
  state.goal_rate = rates_[1].v;
  state.jerk = jerk_[0].q;
}

void SplineSolver::Memory::load_faces(const SplineProblem& problem) {
  ranges_.clear();
  planes_.clear();
  faces_.clear();
  std::span<const HalfSpace> last;
  for (const FacePoint& point : problem.face_points) {
    const std::span faces(problem.faces.data() + point.begin, problem.faces.data() + point.end);
    // The points of a piece mostly have the faces of one polytope.
    if (!std::ranges::equal(faces, last)) load_planes(faces);
    last = faces;
    const auto count = (faces.size() + 3) / 4;
    FaceRange range{point.knot,
                    int(faces_.size()),
                    int(faces_.size() + count),
                    int(planes_.size() - count),
                    {}};
    for (int i = 0; i < 3; ++i) range.map[i] = point.map[i];
    faces_.resize(faces_.size() + count);
    ranges_.push_back(range);
  }
  state.face_points = int(ranges_.size());
  state.ranges = ranges_.data();
  state.planes = planes_.data();
  state.faces = faces_.data();
}

void SplineSolver::Memory::load_planes(std::span<const HalfSpace> faces) {
  for (std::size_t i = 0; i < faces.size(); i += 4) {
    FourFaces& planes = planes_.emplace_back();
    planes.nx = planes.ny = planes.nz = Lanes{};
    planes.offset = Lanes{1.0, 1.0, 1.0, 1.0};  // fills up: no normal, always satisfied
    for (std::size_t j = 0; j < 4 && i + j < faces.size(); ++j) {
      const HalfSpace& face = faces[i + j];
      planes.nx[j] = face.normal[0];
      planes.ny[j] = face.normal[1];
      planes.nz[j] = face.normal[2];
      planes.offset[j] = face.offset_m;
    }
  }
}

namespace {

// @param vertical the horizontal limit over the vertical one
void set_norm(LimitSet& set, LimitNorm norm, double vertical) {
  for (auto& row : set.weights) std::fill(std::begin(row), std::end(row), 0.0);
  switch (norm) {
    case LimitNorm::euclidean:
      set.rows = 1;
      for (double& w : set.weights[0]) w = 1.0;
      break;
    case LimitNorm::per_axis:
      set.rows = 3;
      for (int i = 0; i < 3; ++i) set.weights[i][i] = 1.0;
      break;
    case LimitNorm::horizontal_vertical:
      set.rows = 2;
      set.weights[0][0] = set.weights[0][1] = 1.0;
      set.weights[1][2] = vertical * vertical;
      break;
  }
}

}  // namespace

void SplineSolver::Memory::load_limits(const SplineProblem& problem) {
  set_norm(state.velocity, problem.norm, problem.v_over_vertical);
  set_norm(state.acceleration, problem.norm, problem.a_over_vertical);
  set_norm(state.jerk_limit, LimitNorm::euclidean, 1.0);
  const std::size_t m = std::size_t(state.last);
  for (auto* set : {&velocity_, &acceleration_, &jerk_limit_}) set->clear();
  const bool jerk = !problem.j_max.empty();
  for (std::size_t k = 0; k < m; ++k) {
    load_limit(problem, int(k), 1, velocity_.emplace_back());
    load_limit(problem, int(k), 2, acceleration_.emplace_back());
    if (jerk) load_limit(problem, int(k), 3, jerk_limit_.emplace_back());
  }
  state.velocity.lanes = velocity_.data();
  state.acceleration.lanes = acceleration_.data();
  state.jerk_limit.lanes = jerk ? jerk_limit_.data() : nullptr;
}

void SplineSolver::Memory::load_limit(const SplineProblem& problem, int k, int order,
                                      LimitLanes& to) {
  to = LimitLanes{};
  to.e0 = Lanes{1.0, 1.0, 1.0, 1.0};
  const auto i = std::size_t(k);
  const double T = problem.durations[i];
  const auto& limits = order == 1 ? problem.v_max : order == 2 ? problem.a_max : problem.j_max;
  const int first = k > 0 || order == 3 ? 0 : 1;
  const int end = order == 1 ? 4 : 3;
  for (int j = first; j < end; ++j) {
    const PointMap map = order == 1   ? velocity_point(j, T)
                         : order == 2 ? acceleration_point(j, T)
                                      : jerk_point(j, T);
    // Control points of neighbouring pieces coincide at a knot: one limit, the tighter.
    const bool shared = j == 0 && order < 3;
    const double limit = shared ? std::min(limits[i - 1], limits[i]) : limits[i];
    if (!is_row(map, k, limit,
                order == 1   ? state.velocity
                : order == 2 ? state.acceleration
                             : state.jerk_limit))
      continue;
    for (int b = 0; b < 3; ++b) {
      to.map[b][j] = map.from_first[b] / limit;
      to.map[b + 3][j] = map.from_second[b] / limit;
    }
    if (!state.scale) continue;
    // eta^1.5 for the jerk is not concave: its tangent at 1 is below it, and safe.
    to.e1[j] = order == 3 ? 1.5 : 1.0;
    to.e0[j] = order == 3 ? -0.5 : 0.0;
  }
}

// A point that no unknown moves is checked once and makes no row: the method needs an interior,
// and a constant may lie on its limit.
bool SplineSolver::Memory::is_row(const PointMap& map, int k, double limit, const LimitSet& set) {
  const auto moves = [&](int knot) {
    return (knot > 0 && knot < state.last) || (state.ends_move && state.scale);
  };
  const bool first = !map.from_first.isZero(0.0);
  const bool second = !map.from_second.isZero(0.0);
  if ((first && moves(k)) || (second && moves(k + 1))) return true;
  if (state.scale) return false;  // an end at rest
  const Vec3 y = map(knot(k), knot(k + 1));
  for (int r = 0; r < set.rows; ++r) {
    double square = 0.0;
    for (int c = 0; c < 3; ++c) square += set.weights[r][c] * y[c] * y[c];
    if (!(std::sqrt(square) <= limit * (1.0 + 1e-9))) constant_point_violated = true;
  }
  return false;
}

void SplineSolver::Memory::set_knots(const std::vector<Knot>& knots) {
  for (std::size_t k = 0; k < knots.size(); ++k) {
    for (int b = 0; b < 3; ++b) x_[k].v[b] = padded(knots[k].col(b));
  }
}

Knot SplineSolver::Memory::knot(int k) const {
  Knot knot;
  for (int b = 0; b < 3; ++b) {
    const Lanes& v = x_[std::size_t(k)].v[b];
    knot.col(b) = Vec3(v[0], v[1], v[2]);
  }
  return knot;
}

// The guess has corners, and accelerations many times too large. The smoothest spline near it,
// min integral |p'''|^2 + pull |p_k - guess_k|^2, is one step of Newton's method away.
void SplineSolver::Memory::smooth_guess() {
  const double time_weight = std::exchange(state.time_weight, 0.0);
  const bool ends_move = std::exchange(state.ends_move, false);
  spline_kernels().smooth(state, kPull * jerk_weight_);
  state.time_weight = time_weight;
  state.ends_move = ends_move;
}

void SplineSolver::Memory::start() {
  smooth_guess();
  const SplineKernels& kernels = spline_kernels();
  kernels.evaluate(state);
  if (state.scale && !state.ends_move && state.limit_violation > kFarOff) {
    state.eta = 1.0 + state.limit_violation;
    kernels.evaluate(state);
  }
  std::size_t rows = faces_.size();
  for (const LimitSet* set : {&state.velocity, &state.acceleration, &state.jerk_limit}) {
    if (set->lanes != nullptr) rows += std::size_t(state.last * set->rows);
  }
  state.degree = 4.0 * double(rows);
  const double first_gap = state.scale ? kFirstGap : kFirstGapFixed;
  const double mu = first_gap * std::max(state.objective, 1e-6) / state.degree;
  const auto begin = [&](Row& row) {
    for (int j = 0; j < 4; ++j) {
      row.s[j] = std::max(1.0 - row.residual[j], kStartMargin);
      row.z[j] = mu / row.s[j];
    }
  };
  for (Row& row : faces_) begin(row);
  const auto begin_limits = [&](std::vector<LimitLanes>& limits, const LimitSet& set) {
    for (LimitLanes& l : limits) {
      for (int r = 0; r < set.rows; ++r) begin(l.row[r]);
    }
  };
  begin_limits(velocity_, state.velocity);
  begin_limits(acceleration_, state.acceleration);
  begin_limits(jerk_limit_, state.jerk_limit);
}

}  // namespace goshawk::trajectory_optimizer
