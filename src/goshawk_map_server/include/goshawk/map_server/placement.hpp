#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "goshawk/map_server/frame_tree.hpp"

namespace goshawk::map_server {

/// A cloud as a sensor sends it.
struct SensorCloud {
  std::int64_t stamp_ns = 0;
  std::vector<Vec3> points;               // [m] in the sensor's frame
  std::vector<std::int64_t> offsets_ns;   // when each was measured, after the stamp; or empty: at it
};

/// The same in frame map.
struct PlacedCloud {
  std::vector<Vec3> points_map;
  std::vector<Vec3> origins_map;  // of the sensor: one, or one a point
};

/// The stamps between which poses are needed to place a cloud.
struct TimeSpan {
  std::int64_t first_ns = 0, last_ns = 0;
};
TimeSpan time_span(const SensorCloud& cloud);

/// Places every point by the vehicle's pose at its time, interpolated, in steps of 0.5 ms.
/// @param to_base from the sensor's frame to base_link @param odometry base_link in map
/// @return as PoseBuffer::at; then `placed` is not to be used
Status place(const SensorCloud& cloud, const FrameTree::Chain& to_base, const PoseBuffer& odometry,
             PlacedCloud& placed);

}  // namespace goshawk::map_server
