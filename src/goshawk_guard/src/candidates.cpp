#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "goshawk/guard/guard.hpp"
#include "goshawk/guard/retime.hpp"

namespace goshawk::guard {
namespace {

constexpr double kRounding = 1e-9;
constexpr double kSame = 1e-6;  // [m, m/s, m/s^2] the certificate's tolerance
// A vehicle that hovers moves a little, and a planner begins where it measures it.
constexpr double kHover_m = 0.02, kHover_m_s = 0.05, kHover_m_s2 = 0.5;
constexpr double kMostSlowness = 100.0;

bool begins_there(const FlatState& plan, const FlatState& vehicle, bool at_rest) {
  if (!at_rest) return largest_difference(plan, vehicle) <= kSame;
  return (plan.position - vehicle.position).norm() <= kHover_m &&
         plan.velocity.norm() <= kHover_m_s && plan.acceleration.norm() <= kHover_m_s2;
}

}  // namespace

Guard::Or<Guard::Candidate> Guard::proved(Trajectory trajectory, const FlatState& start,
                                          double deviation_m) const {
  const Limits limits = config_.limits();
  // The curve itself first: no hull is tight enough where that exceeds a limit.
  if (auto excess = excess_of(trajectory, limits, &least_use_of)) return *std::move(excess);
  trajectory = refined(trajectory, limits);
  if (auto excess = excess_of(trajectory, limits, &use_of)) return *std::move(excess);
  auto boxes = boxes_around(trajectory);
  const FlatState end = trajectory.pieces.back().sample(trajectory.pieces.back().duration_s);
  auto certified = certify(std::move(trajectory), std::move(boxes), limits, start, end);
  if (!certified) return Refusal{certified.error()};
  return Candidate{*std::move(certified), deviation_m};
}

std::optional<Guard::Refusal> Guard::excess_of(const Trajectory& trajectory, const Limits& limits,
                                               Use* use_of_piece) {
  const auto worst = std::ranges::max_element(
      trajectory.pieces, {}, [&](const BezierPiece& p) { return use_of_piece(p, limits); });
  const double use = use_of_piece(*worst, limits);
  if (use <= 1.0 + kRounding) return {};
  const Vec3 place = worst->control_points.col(0);
  return Refusal{fail(ErrorCode::trajectory_infeasible,
                      fmt::format("it must be flown {:.3g} times slower to keep the limits at {} m",
                                  use, to_text(place))),
                 place};
}

Guard::Or<Guard::Candidate> Guard::exactly(const Curve& curve, const Join& join) const {
  Trajectory left = remainder(curve.trajectory, join.plan_s);
  const FlatState begins = left.pieces.front().sample(0.0);
  if (begins_there(begins, join.state, join.at_rest)) {
    return proved(std::move(left), begins, curve.deviation_m);
  }
  return Refusal{fail(ErrorCode::not_at_start,
                      fmt::format("it begins {:.2g} m and {:.2g} m/s away from the state that the "
                                  "vehicle will have at {} m",
                                  (begins.position - join.state.position).norm(),
                                  (begins.velocity - join.state.velocity).norm(),
                                  to_text(join.state.position))),
                 join.state.position};
}

// Only from rest: a vehicle that moves cannot fly the same curve at another speed from now on.
Guard::Or<Guard::Candidate> Guard::slowed(const Curve& curve, const Join& join) const {
  const Limits limits = config_.limits();
  Trajectory left = remainder(curve.trajectory, join.plan_s);
  const FlatState planned = left.pieces.front().sample(0.0);
  double factor = 1.0;  // of the curve itself, then of its hulls
  for (const BezierPiece& piece : left.pieces) {
    factor = std::max(factor, least_use_of(piece, limits));
  }
  if (join.at_rest && begins_there(planned, join.state, true) && factor <= kMostSlowness) {
    left = refined(slower(std::move(left), factor), limits);
    const double of_hulls = slowness_of(left, limits) * (1.0 + kRounding);
    left = slower(std::move(left), of_hulls);
    const FlatState begins = left.pieces.front().sample(0.0);
    return proved(std::move(left), begins, curve.deviation_m);
  }
  return Refusal{fail(ErrorCode::trajectory_infeasible,
                      fmt::format("it cannot be flown {:.3g} times slower from here", factor))};
}

Guard::Or<Guard::Candidate> Guard::blended(const Curve& curve, const Join& join,
                                           double over_s) const {
  const double meets_s = join.plan_s + over_s;
  if (meets_s >= curve.trajectory.duration_s() - kSame) {
    return Refusal{fail(ErrorCode::trajectory_infeasible, "it ends before it could be joined")};
  }
  Trajectory whole = remainder(curve.trajectory, meets_s);
  const FlatState meets = whole.pieces.front().sample(0.0);
  const BezierPiece blend = BezierPiece::between(join.state, meets, over_s);
  const Outline replaced = outline(curve.trajectory.until(meets_s), join.plan_s);
  const double off_m = deviation_from({{blend}}, replaced.points_map) + replaced.deviation_m;
  whole.pieces.insert(whole.pieces.begin(), blend);
  return proved(std::move(whole), join.state, curve.deviation_m + off_m);
}

}  // namespace goshawk::guard
