#include "goshawk/px4/estimate.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "goshawk/px4_wire/frames.hpp"

namespace goshawk::px4 {
namespace {

Error lost(const std::string& why) {
  return fail(ErrorCode::tracking_lost, "PX4's estimate is not used: " + why);
}

// Counters are of 8 bits and wrap around.
int moved(std::uint8_t from, std::uint8_t to) {
  return std::uint8_t(to - from);
}

bool rotates(const std::array<float, 4>& q) {
  return std::abs(from_array(q).norm() - 1.0) < 1e-2;
}

}  // namespace

Estimate::Estimate(const Config& config)
    : max_deviation_m_(config.max_position_deviation_m),
      frame_({config.origin_x_m, config.origin_y_m, config.origin_z_m}, config.origin_yaw_rad) {}

Result<std::optional<Estimate::Reset>> Estimate::hear(const VehicleLocalPosition& local) {
  const auto before = std::exchange(local_, local);
  if (!before) return std::optional<Reset>{};
  const int xy = moved(before->xy_reset_counter, local.xy_reset_counter);
  const int z = moved(before->z_reset_counter, local.z_reset_counter);
  const int heading = moved(before->heading_reset_counter, local.heading_reset_counter);
  if (xy == 0 && z == 0 && heading == 0) return std::optional<Reset>{};
  ++resets_;
  if (xy > 1 || z > 1 || heading > 1) {
    return fail(
        ErrorCode::tracking_lost,
        "PX4 reset its estimate several times between two messages, so that its frame is no "
        "longer known in the map: land, and start px4 again with the right origin");
  }
  const Vec3 delta_ned(xy ? local.delta_xy[0] : 0.0, xy ? local.delta_xy[1] : 0.0,
                       z ? local.delta_z : 0.0);
  const double delta_heading = heading ? local.delta_heading : 0.0;
  const Vec3 position_ned(local.x, local.y, local.z);
  if (!delta_ned.allFinite() || !std::isfinite(delta_heading) || !position_ned.allFinite()) {
    return lost("a reset of its position or heading is not finite");
  }
  frame_.reset(swap_world(delta_ned), -delta_heading, swap_world(position_ned));
  return std::optional<Reset>(Reset{delta_ned.norm(), std::abs(delta_heading)});
}

Result<RigidBodyState> Estimate::hear(const VehicleOdometry& odometry) {
  if (counter_ && *counter_ != odometry.reset_counter) wait_for_us_ = odometry.timestamp_sample;
  counter_ = odometry.reset_counter;
  if (auto status = check_flags(); !status) return status.error();
  if (auto status = check_odometry(odometry); !status) return status.error();
  if (local_->timestamp_sample < wait_for_us_) {
    return lost("it was reset, and vehicle_local_position has not told yet by how much");
  }
  const Quaternion q_ned = from_array(odometry.q).normalized();
  const Vec3 velocity = from_array(odometry.velocity);
  const bool in_body = odometry.velocity_frame != VehicleOdometry::kNed;
  RigidBodyState state;
  state.position_map = frame_.point_to_map(swap_world(from_array(odometry.position)));
  state.velocity_map =
      frame_.vector_to_map(swap_world(in_body ? Vec3(q_ned * velocity) : velocity));
  state.q_map_base = frame_.attitude_to_map(swap_attitude(q_ned));
  state.angular_velocity_base = swap_body(from_array(odometry.angular_velocity));
  return state;
}

Status Estimate::check_flags() const {
  if (!local_) return lost("no vehicle_local_position has come, which tells whether it is valid");
  if (!local_->xy_valid || !local_->z_valid) {
    return lost(
        "PX4 says that its local position is not valid: wait for GNSS, or for the external "
        "position that EKF2 is set to use");
  }
  if (!local_->v_xy_valid || !local_->v_z_valid) {
    return lost("PX4 says that its local velocity is not valid");
  }
  if (!local_->heading_good_for_control) {
    return lost(
        "PX4 says that its heading is not good for control: calibrate the compass, or move "
        "until EKF2 has aligned its heading");
  }
  return success();
}

Status Estimate::check_odometry(const VehicleOdometry& odometry) const {
  if (odometry.pose_frame != VehicleOdometry::kNed) {
    return lost(fmt::format("its pose_frame is {}, not 1 (NED): its heading is arbitrary",
                            odometry.pose_frame));
  }
  constexpr std::uint8_t kBodyFrd = 3;
  if (odometry.velocity_frame != VehicleOdometry::kNed && odometry.velocity_frame != kBodyFrd) {
    return lost(fmt::format("its velocity_frame is {}, neither 1 (NED) nor 3 (body)",
                            odometry.velocity_frame));
  }
  const bool finite = from_array(odometry.position).allFinite() &&
                      from_array(odometry.velocity).allFinite() &&
                      from_array(odometry.angular_velocity).allFinite() && rotates(odometry.q);
  if (!finite) {
    return fail(
        ErrorCode::invalid_input,
        "PX4's odometry is refused: a number in it is not finite, or its quaternion has not "
        "the length one");
  }
  const Vec3 variance = from_array(odometry.position_variance);
  if (!variance.allFinite()) return lost("it does not tell how certain its position is");
  const double deviation_m = std::sqrt(variance.maxCoeff());
  if (!(deviation_m <= max_deviation_m_)) {
    return lost(
        fmt::format("its position has a standard deviation of {:.2g} m, more than "
                    "max_position_deviation_m of {:.2g} m: improve the position source, or "
                    "widen that and the margin",
                    deviation_m, max_deviation_m_));
  }
  return success();
}

}  // namespace goshawk::px4
