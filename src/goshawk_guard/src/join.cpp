#include <fmt/format.h>

#include <cmath>

#include "goshawk/guard/guard.hpp"

namespace goshawk::guard {
namespace {

constexpr double kFarthestAhead_s = 5.0;
constexpr double kShortestLeft_s = 0.02;  // of a plan that is worth joining
constexpr double kSearchStep_s = 0.05;
constexpr double kNearer_m = 0.01;  // a later point of the curve must be this much nearer

// Where a curve passes a point: the first of its nearest places.
double nearest_s(const Trajectory& curve, const Vec3& p_map) {
  const double duration_s = curve.duration_s();
  const int steps = std::min(20'000, int(std::ceil(duration_s / kSearchStep_s)));
  double best_s = 0.0, best_m = HUGE_VAL, begin_s = 0.0;
  std::size_t k = 0;
  for (int i = 0; i < steps; ++i) {
    const double t_s = duration_s * i / steps;
    while (k + 1 < curve.pieces.size() && t_s > begin_s + curve.pieces[k].duration_s) {
      begin_s += curve.pieces[k++].duration_s;
    }
    const double off_m = (curve.pieces[k].sample(t_s - begin_s).position - p_map).norm();
    if (off_m >= best_m - kNearer_m) continue;
    best_m = off_m;
    best_s = t_s;
  }
  return best_s;
}

}  // namespace

Guard::Or<Guard::Join> Guard::join_now(std::int64_t start_ns) const {
  const auto state = flown_.at(start_ns);
  if (!state) {
    return Refusal{fail(ErrorCode::not_at_start,
                        "it is not known where the vehicle will be: there is no tracking_state "
                        "yet, or the tracker brakes; plan again once it holds")};
  }
  return Join{.state = *state, .start_ns = start_ns, .at_rest = flown_.rests_from(start_ns)};
}

Guard::Or<Guard::Join> Guard::join_of(const Plan& plan, const Curve& curve,
                                      std::int64_t now_ns) const {
  const double duration_s = curve.trajectory.duration_s();
  std::int64_t start_ns = now_ns + std::llround(config_.lead_s * 1e9);
  double passed_s = 0.0;  // of the plan's own time
  if (plan.start_time_ns) {
    passed_s = (double(start_ns) - double(*plan.start_time_ns)) * 1e-9;
    if (-passed_s > kFarthestAhead_s) {
      return Refusal{fail(ErrorCode::not_at_start,
                          fmt::format("it begins {:.3g} s from now: send it {:g} s ahead at the "
                                      "most; are the clocks the same?",
                                      -passed_s, kFarthestAhead_s))};
    }
    if (passed_s > duration_s - kShortestLeft_s) {
      return Refusal{fail(ErrorCode::deadline_exceeded,
                          fmt::format("it came {:.3g} s after its start and lasts {:.3g} s: plan "
                                      "further ahead; are the clocks the same?",
                                      passed_s, duration_s))};
    }
    if (passed_s < 0.0) start_ns = *plan.start_time_ns;
    passed_s = std::max(0.0, passed_s);
  }
  auto found = join_now(start_ns);
  if (std::holds_alternative<Refusal>(found)) return found;
  Join& join = std::get<Join>(found);
  const bool by_time = plan.start_time_ns && !join.at_rest;
  join.plan_s = by_time ? passed_s : nearest_s(curve.trajectory, join.state.position);
  const Vec3 planned = curve.trajectory.sample(join.plan_s).position;
  const double off_m = (planned - join.state.position).norm();
  if (off_m <= config_.join_within_m) return join;
  return Refusal{fail(ErrorCode::not_at_start,
                      fmt::format("it has the vehicle at {} m where it is to be joined, and the "
                                  "vehicle will be {:.2g} m from there, at {} m: plan from there",
                                  to_text(planned), off_m, to_text(join.state.position))),
                 planned};
}

}  // namespace goshawk::guard
