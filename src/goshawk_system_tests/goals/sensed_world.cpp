#include "sensed_world.hpp"

#include <stdexcept>
#include <vector>

#include "growing_world.hpp"

namespace goshawk::goals {
namespace {

constexpr std::int64_t kPosePeriod_ns = 4'000'000;
constexpr double kRange_m = 8.0;
constexpr double kBodyRadius_m = 0.35;  // seen neither above nor below the vehicle

sensors::SensorParameters lidar_of(const Sensing& sensing) {
  sensors::SensorParameters p;
  sensors::apply_preset(sensors::Preset::vlp16, p);
  p.pattern.rate_hz = 10.0;
  p.pattern.channels = 64;
  p.pattern.columns = 240;
  p.pattern.elevation_lower_rad = -1.3;
  p.pattern.elevation_upper_rad = 1.3;
  p.returns.range_min_m = 0.3;
  p.returns.range_max_m = kRange_m;
  p.returns.range_noise_m = sensing.range_noise_m;
  p.mount.z_m = 0.0;
  p.seed = sensing.seed;
  return p;
}

map_server::LiveMap empty_map(const GridGeometry& world, const Sensing& sensing) {
  // A voxel smaller than the world on each side, as the launch file live.
  const Vec3 edge = Vec3::Constant(sensing.map_voxel_m);
  const map_server::Box box{world.origin_map + edge, world.upper_corner_map() - edge};
  const map_server::Growth growth{map_server::UnknownPolicy::free, kBody_m + kTrackingMargin_m,
                                  sensing.reserve_m};
  return map_server::LiveMap::unknown_space(box, sensing.map_voxel_m, growth).value();
}

}  // namespace

SensedWorld::SensedWorld(const worlds::World& world, const Sensing& sensing)
    : seen_(world.geometry, world.occupied, sensors::Boundary::box),
      lidar_(sensors::Sensor::create(lidar_of(sensing)).value()),
      live_(empty_map(world.geometry, sensing)),
      range_m_(kRange_m) {
  truth_ = std::make_shared<const VoxelGrid>(VoxelGrid{
      .geometry = world.geometry, .grown = world.occupied, .known = {}, .raw = world.occupied});
  map_ = std::make_shared<const VoxelGrid>(live_.grid());
}

bool SensedWorld::sense(const RigidBodyState& vehicle, std::int64_t now_ns) {
  if (last_pose_ns_ >= 0 && now_ns - last_pose_ns_ < kPosePeriod_ns) return false;
  last_pose_ns_ = now_ns;
  if (auto status = track_.add(now_ns, {vehicle.position_map, vehicle.q_map_base}); !status) {
    throw std::logic_error(status.error().message);
  }
  bool came = false;
  const auto status = lidar_.advance(seen_, track_, [&](const sensors::Scan& scan) {
    insert(scan);
    came = true;
  });
  if (!status) throw std::logic_error(status.error().message);
  if (came) map_ = std::make_shared<const VoxelGrid>(live_.grid());
  return came;
}

// By the true pose at each ray, as `cloud_frame: map`.
void SensedWorld::insert(const sensors::Scan& scan) {
  std::vector<Vec3> points, origins;
  for (const sensors::Return& r : scan.returns) {
    if (!r.valid) continue;
    const auto pose = track_.at(scan.start_ns + r.offset_ns);
    if (!pose) continue;
    points.push_back(pose->position_map + pose->q_map_base * r.point.cast<double>());
    origins.push_back(pose->position_map);
  }
  const Vec3 body = track_.at(track_.last_ns())->position_map;
  const map_server::Scan inserted{.points_map = points,
                                  .origins_map = origins,
                                  .max_range_m = range_m_,
                                  .body_path_map = {&body, 1},
                                  .body_radius_m = kBodyRadius_m};
  if (auto status = live_.insert_scan(inserted, result_); !status) {
    throw std::logic_error(status.error().message);
  }
}

}  // namespace goshawk::goals
