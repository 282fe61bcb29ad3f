#include "goshawk/trajectory_optimizer/spline_solver.hpp"

#include <algorithm>
#include <cmath>

#include "spline_solver_parts.hpp"

// The iteration itself and the set-up; the Newton system is in spline_newton.cpp.
namespace goshawk::trajectory_optimizer {
namespace {

constexpr double kStartMargin = 0.1;    // of the first slacks, in the problem's units
constexpr double kStepFraction = 0.99;  // of the way to the boundary

}  // namespace

SplineSolver::Outcome SplineSolver::solve(const SplineProblem& problem, const Settings& settings) {
  set_up(problem);
  Outcome out;
  if (constant_point_violated_) {
    out.status = Status::infeasible;
    return out;
  }
  start_iterates(problem.time_weight);
  const auto converged = [&] {
    return primal_residual_ <= settings.feasibility &&
           gap_ <= settings.gap * std::abs(objective_) + 1e-14;
  };
  for (;; ++out.iterations) {
    evaluate_cost(problem.time_weight);
    const bool inside = linearise();
    out.objective = objective_;
    out.gap = gap_;
    out.primal_residual = primal_residual_;
    out.dual_residual = dual_residual_;
    out.eta = eta_;
    if (converged() && dual_residual_ <= settings.dual_feasibility) {
      out.status = Status::solved;
      break;
    }
    if (proves_infeasible()) {
      out.status = Status::infeasible;
      break;
    }
    if (out.iterations >= settings.max_iterations) {
      out.status = Status::iteration_limit;
      break;
    }
    if (!inside || !factor()) break;
    const double reach = std::min(1.0, predict());
    const double sigma = (1.0 - reach) * (1.0 - reach);
    const double step = std::min(1.0, kStepFraction * correct(sigma));
    if (!(step > 1e-8)) break;
    apply_step(step);
  }
  // Rounding ends the method before the dual residual where slacks are tiny; what counts for the
  // answer, its feasibility and its gap, is there already.
  if (out.status == Status::numerical_trouble && out.dual_residual <= 1e-4 && converged()) {
    out.status = Status::solved;
  }
  for (int k = 0; k <= last_; ++k) solution_[std::size_t(k)] = joint_of(x_, k);
  return out;
}

void SplineSolver::set_up(const SplineProblem& problem) {
  scale_ = problem.scale;
  eta_ = 1.0;
  last_ = problem.pieces();
  start_rate_ = scale_ ? problem.start_rate : Joint::Zero();
  goal_rate_ = scale_ ? problem.goal_rate : Joint::Zero();
  const std::size_t size = std::size_t(last_ + 1) * kBlock;
  for (auto* x : {&x_, &cost_gradient_, &dual_, &rhs_, &dx_}) x->assign(size, 0.0);
  for (int k = 0; k <= last_; ++k) joint_of(x_, k) = problem.joints[std::size_t(k)];
  solution_.resize(std::size_t(last_) + 1);
  hessian_.resize(std::size_t(last_) + 1);
  jerk_.clear();
  for (const double T : problem.durations) {
    jerk_.push_back(problem.jerk_weight * jerk_hessian(T));
  }
  faces_ = problem.faces;
  face_points_ = problem.face_points;
  rows_.resize(faces_.size());
  constant_point_violated_ = false;
  for_each_set([](auto& set) {
    set.points.clear();
    set.cones.clear();
  });
  add_limits(problem);
}

// Control points of neighbouring pieces coincide at a joint: one limit, the tighter.
void SplineSolver::add_limits(const SplineProblem& problem) {
  for (int k = 0; k < last_; ++k) {
    const auto i = std::size_t(k);
    const double T = problem.durations[i];
    if (k > 0) {
      const double v_max = std::min(problem.v_max[i - 1], problem.v_max[i]);
      const double a_max = std::min(problem.a_max[i - 1], problem.a_max[i]);
      add_limit(problem, true, {k, false, velocity_point(0, T), v_max});
      add_limit(problem, false, {k, false, acceleration_point(0, T), a_max});
    }
    for (int j = 1; j <= 3; ++j) {
      add_limit(problem, true, {k, j != 1, velocity_point(j, T), problem.v_max[i]});
    }
    for (int j = 1; j <= 2; ++j) {
      add_limit(problem, false, {k, true, acceleration_point(j, T), problem.a_max[i]});
    }
  }
}

// A point that no unknown moves is checked once and makes no cone: the method needs an interior,
// and a constant may lie on its limit.
void SplineSolver::add_limit(const SplineProblem& problem, bool velocity, const LimitPoint& point) {
  const bool per_axis = problem.norm == LimitNorm::per_axis;
  if (!touches_unknown(point)) {
    const Vec3 y = value(point, x_);
    if (!scale_) {
      const double size = per_axis ? y.cwiseAbs().maxCoeff() : y.norm();
      if (!(size <= point.limit * (1.0 + 1e-9))) constant_point_violated_ = true;
      return;
    }
    if (y.isZero(0.0)) return;
  }
  const auto add = [&](auto& set) {
    set.points.push_back(point);
    for (int c = 0; c < set.kConesPerPoint; ++c) {
      set.cones.emplace_back();
      set.cones.back().set_limit(point.limit);
    }
  };
  if (velocity && scale_) {
    per_axis ? add(velocity_axis_) : add(velocity_);
  } else {
    per_axis ? add(plain_axis_) : add(plain_);
  }
}

bool SplineSolver::moves(int joint) const {
  if (joint == 0) return !start_rate_.isZero(0.0);
  if (joint == last_) return !goal_rate_.isZero(0.0);
  return true;
}

bool SplineSolver::touches_unknown(const LimitPoint& point) const {
  const bool first = !point.map.from_first.isZero(0.0) && moves(point.joint);
  return first || (point.second && moves(point.joint + 1));
}

// Slacks near what the guess gives, multipliers that make every product equal: a start on the
// central path, for the price of one pass.
void SplineSolver::start_iterates(double time_weight) {
  degree_ = double(rows_.size());
  for_each_set([&](auto& set) { degree_ += double(set.cones.size()); });
  degree_ = std::max(degree_, 1.0);
  evaluate_cost(time_weight);
  const double mu = std::max(objective_, 1e-6) / degree_;
  for (const FacePoint& point : face_points_) {
    const Vec3 y = joint_of(x_, point.joint) * point.map;
    for (int i = point.begin; i < point.end; ++i) {
      const Face& face = faces_[std::size_t(i)];
      FaceRow& row = rows_[std::size_t(i)];
      row.s = std::max(face.offset - face.normal.dot(y), kStartMargin);
      row.z = mu / row.s;
    }
  }
  for_each_set([&](auto& set) {
    for_each_cone(set, x_, [&](auto& cone, const auto& y) {
      cone.start(cone.slack(y, eta_), kStartMargin, mu);
    });
  });
}

void SplineSolver::apply_step(double step) {
  for (std::size_t i = 0; i < x_.size(); ++i) x_[i] += step * dx_[i];
  eta_ += step * deta_;
  for (FaceRow& row : rows_) {
    row.s += step * row.ds;
    row.z += step * row.dz;
  }
  for_each_set([&](auto& set) {
    for (auto& cone : set.cones) {
      cone.s += step * cone.ds;
      cone.z += step * cone.dz;
    }
  });
}

}  // namespace goshawk::trajectory_optimizer
