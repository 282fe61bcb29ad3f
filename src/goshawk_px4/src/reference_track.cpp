#include "goshawk/px4/reference_track.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace goshawk::px4 {
namespace {

constexpr double kOverSpeed = 1.05;
constexpr double kJoin_m = 0.05;  // two references of one path, some milliseconds apart

}  // namespace

ReferenceTrack::ReferenceTrack(const Config& config) : config_(config) {}

void ReferenceTrack::hold(const RigidBodyState& vehicle) {
  const Vec3& v = vehicle.velocity_map;
  held_map_ = vehicle.position_map + v * (v.norm() / (2.0 * config_.brake_m_s2));
  yaw_rad_ = yaw_of(vehicle.q_map_base);
  climb_m_ = 0.0;
  stop_.reset();
}

void ReferenceTrack::climb(double height_m, std::int64_t now_ns) {
  climb_m_ = height_m;
  begin_ns_ = now_ns;
}

Status ReferenceTrack::offer(FallbackStop stop, const RigidBodyState& vehicle,
                             std::int64_t now_ns) {
  const FlatState first = stop.at(0.0);
  const double speed = std::max(first.velocity.norm(), stop.at(0.1).velocity.norm());
  if (speed > kOverSpeed * config_.v_max_m_s) {
    return fail(
        ErrorCode::trajectory_infeasible,
        fmt::format("the tracker wants {:.2g} m/s, more than v_max_m_s of {:.2g} m/s of px4, "
                    "which margin_m covers: stopping; set the navigator's v_max_m_s no higher",
                    speed, config_.v_max_m_s));
  }
  const double from_vehicle_m = (first.position - vehicle.position_map).norm();
  const bool goes_on = stop_ && (first.position - at(now_ns).position).norm() <= kJoin_m;
  if (!goes_on && from_vehicle_m > config_.engage_distance_m) {
    return fail(ErrorCode::not_at_start,
                fmt::format("the tracker's reference is {:.2g} m from the vehicle, more than "
                            "engage_distance_m of {:.2g} m: holding",
                            from_vehicle_m, config_.engage_distance_m));
  }
  stop_ = std::move(stop);
  begin_ns_ = now_ns;
  return success();
}

FlatState ReferenceTrack::at(std::int64_t now_ns) const {
  const double t_s = double(now_ns - begin_ns_) * 1e-9;
  if (stop_) return stop_->at(t_s);
  FlatState state{.position = held_map_};
  if (climb_m_ > 0.0) {
    const double climbed_m = config_.takeoff_speed_m_s * t_s;
    state.position.z() += std::min(climbed_m, climb_m_);
    if (climbed_m < climb_m_) state.velocity.z() = config_.takeoff_speed_m_s;
  }
  return state;
}

bool ReferenceTrack::at_rest(std::int64_t now_ns) const {
  const double t_s = double(now_ns - begin_ns_) * 1e-9;
  if (stop_) return t_s >= stop_->duration_s();
  return config_.takeoff_speed_m_s * t_s >= climb_m_;
}

std::optional<double> ReferenceTrack::age_s(std::int64_t now_ns) const {
  if (!stop_) return {};
  return double(now_ns - begin_ns_) * 1e-9;
}

}  // namespace goshawk::px4
