#include "goshawk/simulator/fallback_pilot.hpp"

#include <fmt/format.h>

#include <cmath>

#include "goshawk/core/flatness.hpp"
#include "goshawk/simulator/force_limits.hpp"

namespace goshawk::simulator {
namespace {

constexpr double kFollowPosition_1_s2 = 16.0;
constexpr double kFollowVelocity_1_s = 6.8;
constexpr double kActuation_s = 0.03;       // feedforward is taken this far ahead
constexpr double kSearch_s = 0.3;           // before and after where it should be by now
constexpr double kOtherVelocity_m_s = 0.6;  // more than this is another way

}  // namespace

FallbackPilot::FallbackPilot(const plant::VehicleParameters& parameters, double max_tilt_rad,
                             double tolerance_m)
    : parameters_(parameters), max_tilt_rad_(max_tilt_rad), tolerance_m_(tolerance_m) {}

void FallbackPilot::forget() {
  stop_.reset();
}

std::optional<double> FallbackPilot::find(const FallbackStop& stop, const RigidBodyState& state,
                                          double expected_s) const {
  const double t_s =
      stop.nearest_time_s(state.position_map, expected_s - kSearch_s, expected_s + kSearch_s);
  const FlatState there = stop.at(t_s);
  const bool passes = (there.position - state.position_map).norm() <= tolerance_m_ &&
                      (there.velocity - state.velocity_map).norm() <= kOtherVelocity_m_s;
  return passes ? std::optional(t_s) : std::nullopt;
}

Status FallbackPilot::offer(FallbackStop stop, const RigidBodyState& state, std::int64_t now_ns) {
  if (auto status = stop.check(); !status) return status;
  if (!find(stop, state, 0.0)) {
    return fail(
        ErrorCode::not_at_start,
        fmt::format("fallback stop refused: it begins at {} m with {} m/s, and the vehicle "
                    "is at {} m with {} m/s",
                    to_text(stop.states.front().position), to_text(stop.states.front().velocity),
                    to_text(state.position_map), to_text(state.velocity_map)));
  }
  stop_ = std::move(stop);
  begin_ns_ = now_ns;
  return success();
}

bool FallbackPilot::engage(const RigidBodyState& state, std::int64_t now_ns) {
  if (!stop_) return false;
  const auto t_s = find(*stop_, state, along_s(now_ns));
  if (!t_s) return false;
  begin_ns_ = now_ns - std::llround(*t_s * 1e9);
  yaw_rad_ = yaw_of(state.q_map_base);
  return true;
}

AttitudeSetpoint FallbackPilot::step(const RigidBodyState& state, std::int64_t now_ns,
                                     const Vec3& disturbance_map) const {
  const FlatState now = stop_->at(along_s(now_ns));
  const FlatState ahead = stop_->at(along_s(now_ns) + kActuation_s);
  const Vec3 acceleration = ahead.acceleration - disturbance_map +
                            kFollowPosition_1_s2 * (now.position - state.position_map) +
                            kFollowVelocity_1_s * (now.velocity - state.velocity_map);
  const Vec3 force = limited_force(parameters_, max_tilt_rad_, acceleration);
  return thrust_attitude_of(force / parameters_.mass_kg, ahead.jerk, yaw_rad_, 0.0,
                            parameters_.mass_kg);
}

std::optional<Vec3> FallbackPilot::ended(std::int64_t now_ns) const {
  if (along_s(now_ns) < stop_->duration_s()) return {};
  return stop_->states.back().position;
}

}  // namespace goshawk::simulator
