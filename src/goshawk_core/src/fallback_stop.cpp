#include "goshawk/core/fallback_stop.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace goshawk {
namespace {

constexpr double kBriefestStep_s = 1e-6;
constexpr double kLongestStep_s = 10.0;
// [m], [m/s], [m/s^2] beyond any vehicle; what is computed from less stays finite.
constexpr double kMostOfAState = 1e6;
constexpr double kFallbackAtRest = 1e-6;  // [m/s] and [m/s^2]
constexpr int kLooksPerStep = 4;

// NaN is not within bounds.
bool is_within_bounds(const FlatState& state) {
  return (state.position.array().abs() <= kMostOfAState).all() &&
         (state.velocity.array().abs() <= kMostOfAState).all() &&
         (state.acceleration.array().abs() <= kMostOfAState).all();
}

}  // namespace

FlatState FallbackStop::at(double t_s) const {
  const double t = std::max(0.0, t_s);
  if (t >= duration_s()) return {.position = states.back().position};
  const std::size_t i = std::min(std::size_t(t / step_s), states.size() - 2);
  const double in_step_s = std::clamp(t - step_s * double(i), 0.0, step_s);
  return BezierPiece::between(states[i], states[i + 1], step_s).sample(in_step_s);
}

// The nearest of equal steps, then where the tangent there is nearest.
double FallbackStop::nearest_time_s(const Vec3& position_map, double from_s, double to_s) const {
  const double begin_s = std::clamp(from_s, 0.0, duration_s());
  const double end_s = std::clamp(to_s, 0.0, duration_s());
  const int looks = 1 + int((end_s - begin_s) / step_s * kLooksPerStep);
  double best_s = begin_s;
  double least_m = HUGE_VAL;
  for (int i = 0; i <= looks; ++i) {
    const double t_s = begin_s + (end_s - begin_s) * i / looks;
    const double distance_m = (at(t_s).position - position_map).norm();
    if (distance_m >= least_m) continue;
    least_m = distance_m;
    best_s = t_s;
  }
  const FlatState best = at(best_s);
  const double squared_speed = best.velocity.squaredNorm();
  if (squared_speed < kFallbackAtRest) return best_s;
  const double late_s = (position_map - best.position).dot(best.velocity) / squared_speed;
  return std::clamp(best_s + late_s, begin_s, end_s);
}

Status FallbackStop::check() const {
  const auto refuse = [](const std::string& why) {
    return fail(ErrorCode::invalid_input, "fallback stop refused: " + why);
  };
  if (states.empty() || states.size() > kMostStates) {
    return refuse(
        fmt::format("it has {} states: it must have 1 to {}", states.size(), kMostStates));
  }
  if (!(step_s >= kBriefestStep_s && step_s <= kLongestStep_s)) {
    return refuse(fmt::format("its step is {:.3g} s: it must be {:g} to {:g} s", step_s,
                              kBriefestStep_s, kLongestStep_s));
  }
  if (!std::ranges::all_of(states, is_within_bounds)) {
    return refuse(
        fmt::format("a number in it is not finite, or beyond {:g} m, m/s or m/s^2", kMostOfAState));
  }
  const FlatState& last = states.back();
  if (last.velocity.norm() > kFallbackAtRest || last.acceleration.norm() > kFallbackAtRest) {
    return refuse("its last state moves: it must end at rest");
  }
  return success();
}

}  // namespace goshawk
