#pragma once

#include <memory>
#include <vector>

#include "goshawk/map_server/live_map.hpp"
#include "goshawk/sensors/sensor.hpp"

namespace goshawk::closed_loop {

/// A sensor in a true world, and the map that is made of its scans: what a vehicle knows that began
/// knowing nothing. Unknown space is free for planning. The same calls give the same bits.
class LiveMapper {
 public:
  struct Config {
    sensors::SensorParameters sensor = {};
    map_server::Box box = {};    // [m] what the map covers, frame map
    double resolution_m = 0.2;   // edge of a voxel
    double inflation_m = 0.2;    // radius of the body and margin
    double reserve_m = 0.0;      // that plans keep beyond it (docs/replanning.md)
    double body_radius_m = 0.3;  // voxels nearer than this to where the body was are free
    /// A ray without return has crossed free space up to the sensor's range. True of lidars that
    /// tell a ray that was fired without return from one that was lost.
    bool missing_is_free = true;
  };

  /// @param world where scans are taken @return invalid_parameter, map_too_large
  static Result<LiveMapper> create(const Config& config,
                                   std::shared_ptr<const sensors::World> world);

  /// The vehicle is there at that moment. Scans that are complete by then are in the map.
  /// @return whether the map is another one now; collision: the sensor sits inside an obstacle;
  ///   invalid_input: the pose is not finite
  Result<bool> look(std::int64_t time_ns, const sensors::Pose& pose);

  /// Its own from version to version: holders of an older one keep what they have.
  const std::shared_ptr<const VoxelGrid>& map() const { return map_; }
  int scans() const { return scans_; }

 private:
  LiveMapper(const Config& config, std::shared_ptr<const sensors::World> world,
             sensors::Sensor sensor, map_server::LiveMap live);
  void insert(const sensors::Scan& scan);
  void publish();

  Config config_;
  std::shared_ptr<const sensors::World> world_;
  sensors::Sensor sensor_;
  map_server::LiveMap live_;
  sensors::PoseTrack track_;
  std::vector<Vec3> points_map_, origins_map_, path_map_;
  map_server::ScanResult result_;
  VoxelGrid grid_;
  std::shared_ptr<const VoxelGrid> map_;
  int scans_ = 0;
  bool changed_ = false;
};

}  // namespace goshawk::closed_loop
