#pragma once

#include <memory>

#include "goshawk/core/vehicle.hpp"
#include "goshawk/map_server/live_map.hpp"
#include "goshawk/sensors/sensor.hpp"
#include "goshawk/sensors/voxel_world.hpp"
#include "goshawk/worlds/world.hpp"

namespace goshawk::goals {

/// What a live map is made with.
struct Sensing {
  double range_noise_m = 0.01;  // one sigma
  double map_voxel_m = 0.2;
  double reserve_m = 0.2;
  int seed = 1;
};

/// A world, and the live map that a lidar with noise makes of it as the vehicle moves. World and
/// map are on rasters of their own.
class SensedWorld {
 public:
  SensedWorld(const worlds::World& world, const Sensing& sensing);

  /// The world as it is: all known.
  const std::shared_ptr<const VoxelGrid>& truth() const { return truth_; }
  const std::shared_ptr<const VoxelGrid>& map() const { return map_; }

  /// To be called every few milliseconds. @return whether a scan has come, and the map is new
  bool sense(const RigidBodyState& vehicle, std::int64_t now_ns);

 private:
  void insert(const sensors::Scan& scan);

  std::shared_ptr<const VoxelGrid> truth_, map_;
  sensors::VoxelWorld seen_;
  sensors::Sensor lidar_;
  sensors::PoseTrack track_;
  map_server::LiveMap live_;
  map_server::ScanResult result_;
  double range_m_;
  std::int64_t last_pose_ns_ = -1;
};

}  // namespace goshawk::goals
