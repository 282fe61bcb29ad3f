#include "goshawk/trajectory_optimizer/plan.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "cut.hpp"
#include "goshawk/trajectory_optimizer/time_profile.hpp"

namespace goshawk::trajectory_optimizer {
namespace {

constexpr double kLeastLength = 1e-6;  // [m] of a path, for the estimate of its duration
constexpr double kShortest = 0.01;     // of a mean piece: shorter ones cost accuracy

constexpr double kCorner = 0.6;  // of v^2 / a: how far a corner is cut, generously

double speed_along(const FlatState& state, const Vec3& from, const Vec3& to) {
  const Vec3 step = to - from;
  return step.norm() > 0.0 ? std::max(0.0, state.velocity.dot(step) / step.norm()) : 0.0;
}

double path_length(const std::vector<Vec3>& waypoints) {
  double length = 0.0;
  for (std::size_t k = 0; k + 1 < waypoints.size(); ++k) {
    length += (waypoints[k + 1] - waypoints[k]).norm();
  }
  return length;
}

}  // namespace

bool from_rest_to_rest(const PlanRequest& request) {
  return !is_moving(request.start) && !is_moving(request.goal);
}

double Plan::duration_s() const {
  return std::accumulate(durations_s.begin(), durations_s.end(), 0.0);
}

Plan cut_trapezoid(const PlanRequest& request, const Corridor& corridor, const Config& config,
                   const Lead& lead) {
  const auto& waypoints = corridor.waypoints_map;
  const std::size_t n = waypoints.size() - 1;
  const TimeProfile profile(waypoints, request.limits,
                            speed_along(request.start, waypoints[0], waypoints[1]),
                            speed_along(request.goal, waypoints[n - 1], waypoints[n]));
  Plan plan;
  plan.stays = from_rest_to_rest(request) && path_length(waypoints) <= kLeastLength;
  plan.reference_s = plan.stays ? config.piece_duration_s : profile.duration_s();
  plan.reference_s = std::max(
      plan.reference_s,
      rest_to_rest_duration_s(kLeastLength, request.limits.v_max_m_s, request.limits.a_max_m_s2));
  plan.at_moving_end = lead.first_piece;
  const auto cutter = Cutter::of(request, config, plan.reference_s, plan.at_moving_end);
  double begin = 0.0;
  plan.knots.push_back(request.start);
  for (int k = 0; k < profile.segments(); ++k) {
    const double trapezoid =
        plan.stays ? plan.reference_s / profile.segments() : profile.duration_s(k);
    const double stretch = k == 0 ? lead.first_segment : 1.0;
    const double duration = stretch * trapezoid;
    cutter.cut(begin, duration, [&](double t, double piece) {
      append(plan, std::max(piece, kShortest * cutter.longest_s), k,
             profile.state(k, std::min(t / stretch, trapezoid)));
    });
    begin += duration;
  }
  plan.knots.back() = request.goal;
  plan.braking_s = lead.braking * StartAllowance::of(request.start, request.limits).until_s;
  return plan;
}

double corner_reach_m(const Plan& plan, const Limits& limits) {
  const double v = limits.v_max_m_s;
  return kCorner * std::min(v * v / limits.a_max_m_s2, 0.5 * v * plan.reference_s);
}

double natural_jerk(const Plan& plan, const Limits& limits) {
  const double ramp_s = std::min(limits.v_max_m_s / limits.a_max_m_s2, 0.5 * plan.reference_s);
  return limits.a_max_m_s2 / ramp_s;
}

Trajectory make_trajectory(const Plan& plan) {
  Trajectory trajectory;
  trajectory.pieces.reserve(plan.durations_s.size());
  for (std::size_t k = 0; k < plan.durations_s.size(); ++k) {
    trajectory.pieces.push_back(plan.piece(k));
    trajectory.pieces.back().polytope = plan.polytopes[k];
  }
  return trajectory;
}

}  // namespace goshawk::trajectory_optimizer
