#pragma once

#include <functional>
#include <optional>

#include "goshawk/core/grid_geometry.hpp"
#include "nav_msgs.h"
#include "octomap_msgs.h"
#include "sensor_msgs.h"
#include "tally.hpp"

namespace goshawk::conformance {

/// Stands in for the sensor and for readers of the map: sends scans of invented walls in front of a
/// vehicle in the middle of the map, and judges how the map changes.
class MapExaminer {
 public:
  MapExaminer(runtime::Context& context, const Options& options);

  /// @param recorded clouds that are sent beside the generated ones
  Result<Report> examine(const std::vector<sensor_msgs::msg::PointCloud2>& recorded);

 private:
  using Cloud = sensor_msgs::msg::PointCloud2;

  bool spin_until(double timeout_s, const std::function<bool()>& done);
  void take_whole(const goshawk_msgs::msg::VoxelGrid& m);
  void take_update(const goshawk_msgs::msg::VoxelGridUpdate& m);
  void examine_first_map();
  void examine_late_joiner();
  void examine_octomap();
  void place_vehicle(std::int64_t stamp_ns);
  void send_vehicle();
  /// Sends a cloud. @return whether the map changed within the timeout
  bool see(const Cloud& cloud);
  /// Points of a wall across the x axis. @param ahead_m from the vehicle
  std::vector<Vec3> wall(double ahead_m) const;
  void examine_scan();
  void examine_bad();
  void examine_recorded(const std::vector<Cloud>& recorded);
  void examine_garbage();

  const Options& options_;
  runtime::Context& context_;
  runtime::Node node_;
  ReportListener listener_;
  runtime::Publisher<Cloud> clouds_;
  runtime::Publisher<nav_msgs::msg::Odometry> odometry_;
  Report report_;

  std::optional<VoxelGrid> grid_;  // the newest, updates applied
  int wholes_ = 0;
  std::uint64_t whole_version_ = 0;  // of the newest whole map
  std::int64_t changed_ns_ = 0;
  std::optional<octomap_msgs::msg::Octomap> octomap_;
  Vec3 vehicle_map_ = Vec3::Zero();
  Tally wholes_valid_{"whole maps are valid"};
  Tally chain_{"updates are consecutive and lead to the next whole map"};
  std::vector<double> latencies_s_;
};

}  // namespace goshawk::conformance
