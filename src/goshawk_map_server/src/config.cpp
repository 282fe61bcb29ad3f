#include "goshawk/map_server/config.hpp"

#include <stdexcept>

namespace goshawk::map_server {
namespace {

std::optional<Box> box_of(const Config& c) {
  if (!c.use_box) return {};
  return Box{Vec3(c.box_x_min_m, c.box_y_min_m, c.box_z_min_m),
             Vec3(c.box_x_max_m, c.box_y_max_m, c.box_z_max_m)};
}

CloudMeaning cloud_meaning(const std::string& word) {
  if (word == "map") return CloudMeaning::map;
  if (word == "points") return CloudMeaning::points;
  if (word == "scan") return CloudMeaning::scan;
  throw std::invalid_argument("cloud_meaning '" + word + "'");
}

}  // namespace

LoadOptions load_options(const Config& config) {
  LoadOptions options;
  options.resolution_m = config.resolution_m;
  options.cloud = cloud_meaning(config.cloud_meaning);
  options.max_range_m = config.max_range_m;
  options.box = box_of(config);
  options.max_voxels = config.max_voxels;
  return options;
}

VoxelizeOptions voxelize_options(const Config& config) {
  return {box_of(config), config.max_voxels};
}

Growth growth(const Config& config) {
  const auto policy = unknown_policy(config.unknown);
  if (!policy) throw std::invalid_argument("unknown '" + config.unknown + "'");
  return {*policy, config.radius_m + config.margin_m};
}

}  // namespace goshawk::map_server
