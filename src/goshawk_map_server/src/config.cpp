#include "goshawk/map_server/config.hpp"

#include <fmt/format.h>

namespace goshawk::map_server {
namespace {

std::optional<Box> box_of(const Config& c) {
  if (!c.use_box) return {};
  return Box{Vec3(c.box_x_min_m, c.box_y_min_m, c.box_z_min_m),
             Vec3(c.box_x_max_m, c.box_y_max_m, c.box_z_max_m)};
}

}  // namespace

LoadOptions load_options(const Config& config) {
  LoadOptions options;
  options.resolution_m = config.resolution_m;
  options.cloud = config.cloud_meaning;
  options.frame = config.cloud_frame;
  options.scale = config.cloud_scale;
  options.origin_file = {config.cloud_origin_x_m, config.cloud_origin_y_m, config.cloud_origin_z_m};
  options.max_range_m = config.max_range_m;
  options.box = box_of(config);
  options.max_voxels = config.max_voxels;
  return options;
}

VoxelizeOptions voxelize_options(const Config& config) {
  return {box_of(config), config.max_voxels};
}

Growth growth(const Config& config) {
  return {config.unknown, config.radius_m + config.margin_m, config.reserve_m};
}

Result<LiveOptions> live_options(const Config& config) {
  const auto odds = OddsModel::make(config.hits_needed, config.misses_needed);
  if (!odds) return odds.error();
  LiveOptions options;
  options.odds = *odds;
  options.follows = config.follow_vehicle;
  options.max_kept_bytes = std::int64_t{config.max_kept_mb} * 1'000'000;
  options.max_voxels = config.max_voxels;
  return options;
}

Error forgotten_fault(const Config& config) {
  const char* then = config.unknown == UnknownPolicy::free ? ", which this map takes for free" : "";
  return fail(ErrorCode::map_too_large,
              fmt::format("what left the window takes more than max_kept_mb ({} MB): what left "
                          "first is forgotten from now on, obstacles too, and is unknown space "
                          "when the window comes back{}. Raise max_kept_mb",
                          config.max_kept_mb, then));
}

Pose sensor_mount(const Config& c) {
  using Eigen::AngleAxisd;
  const Quaternion q(AngleAxisd(c.sensor_yaw_rad, Vec3::UnitZ()) *
                     AngleAxisd(c.sensor_pitch_rad, Vec3::UnitY()) *
                     AngleAxisd(c.sensor_roll_rad, Vec3::UnitX()));
  return {Vec3(c.sensor_x_m, c.sensor_y_m, c.sensor_z_m), q};
}

}  // namespace goshawk::map_server
