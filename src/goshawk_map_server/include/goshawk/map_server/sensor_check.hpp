#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "goshawk/core/result.hpp"
#include "goshawk/map_server/placement.hpp"

namespace goshawk::map_server {

/// A cloud of a recording.
struct RecordedCloud {
  SensorCloud cloud;             // finite points only, in the sensor's frame
  std::int64_t claimed = 0;      // points of the message, missing returns among them
  std::int64_t received_ns = 0;  // by the recorder's clock
};

struct SensorCheckOptions {
  double resolution_m = 0.2;  // of the map
  double body_reach_m = 0.7;  // what the sensor may see of the vehicle lies within
  double a_max_m_s2 = 2.0;    // with which the vehicle stops
  double reaction_s = 0.1;    // from a changed map to a new setpoint
  double margin_m = 0.5;      // kept from what the vehicle stops before
};

/// A sector of azimuths [rad], counter-clockwise from the sensor's x.
struct Sector {
  double from_rad = 0.0, to_rad = 0.0;
};

/// What a minute of a sensor tells of it.
struct SensorReport {
  std::int64_t clouds = 0;
  double duration_s = 0.0, rate_hz = 0.0, longest_gap_s = 0.0;
  double latency_mean_s = 0.0, latency_max_s = 0.0;  // from the last point to the receipt
  double points = 0.0;                               // that returned, mean of the clouds
  double missing_share = 0.0;                        // of those claimed
  double range_least_m = 0.0, range_median_m = 0.0,
         range_most_m = 0.0;  // 1st, 50th, 99th percentile
  double elevation_lower_rad = 0.0, elevation_upper_rad = 0.0;
  std::vector<Sector> blind;   // azimuths without any return
  double body_share = 0.0;     // of the returns: near ones in the same direction in most clouds
  double body_reach_m = 0.0;   // how far off the farthest of them is; 0: none
  double dense_range_m = 0.0;  // up to here neighbouring points are a voxel apart
  double speed_m_s = 0.0;      // from which the vehicle stops within what it sees
};

/// @return invalid_input for fewer than two clouds, or clouds without any return
Result<SensorReport> check_sensor(const std::vector<RecordedCloud>& clouds,
                                  const SensorCheckOptions& options);

/// The turn of the sensor about its own axes that draws the walls thinnest.
struct MountReport {
  Vec3 correction_rad = Vec3::Zero();  // roll, pitch, yaw to add to the mount
  double thinner_share = 0.0;          // of the occupied voxels that it saves
  bool suspicious = false;             // more than chance: the walls are double
};

/// Places the clouds by odometry and counts the voxels that they fill, with the mount as it is and
/// turned a little. An error that shifts all walls alike cannot be seen: the vehicle must turn and
/// move. Clouds that no pose is known for are left out.
/// @param to_base the sensor in base_link
/// @return tracking_lost if fewer than five clouds could be placed; invalid_input if the vehicle
/// turned by less than 0.5 rad
Result<MountReport> check_mount(const std::vector<RecordedCloud>& clouds, const Pose& to_base,
                                const PoseBuffer& odometry, double resolution_m);

}  // namespace goshawk::map_server
