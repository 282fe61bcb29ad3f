#include <algorithm>
#include <cmath>

#include "clock_time.hpp"
#include "goshawk/tracker/tracker.hpp"

// What the vehicle is given in advance, for when the tracker falls silent.

namespace goshawk::tracker {
namespace {

constexpr double kStep_s = 0.05;
constexpr double kLeastStep_s = 1e-3;  // the last moment before rest

}  // namespace

bool Tracker::make_fallback(FallbackStop& stop, std::int64_t now_ns) const {
  const bool knows = has_state_ && !whereabouts_lost_ && refused_.code == ErrorCode::ok;
  if (!knows || !within_bound(now_ns)) return false;
  const std::int64_t brake_ns = now_ns + std::llround(config_.fallback_after_s * 1e9);
  Reference braked = flown_at(brake_ns);
  braked.brake(brake_ns, config_.brake_acceleration_m_s2);
  const double rest_s = braked.seconds_to_rest(now_ns);
  const int steps = std::min(int(std::ceil(rest_s / kStep_s)), int(FallbackStop::kMostStates) - 1);
  stop.step_s = steps > 0 ? std::max(rest_s / steps, kLeastStep_s) : kStep_s;
  stop.states.resize(std::size_t(steps) + 1);
  for (int i = 0; i <= steps; ++i) {
    const std::int64_t time_ns = now_ns + std::llround(1e9 * stop.step_s * i);
    const bool before = time_ns < brake_ns;
    stop.states[std::size_t(i)] = before ? reference_at(time_ns) : braked.at(time_ns);
  }
  const Vec3 end = stop.states.back().position;
  stop.states.back() = {.position = end};  // a rounded time may lie just before the rest
  return true;
}

}  // namespace goshawk::tracker
