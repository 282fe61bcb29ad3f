#include "planning/map_options.hpp"

#include <fmt/ranges.h>

#include <charconv>

#include "goshawk/map_server/octree.hpp"
#include "goshawk/worlds/world.hpp"

namespace goshawk::cli {
namespace {

Status read_number(const std::string& text, const char* option, double& value) {
  if (text.empty()) return success();
  const char* end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, value);
  if (error == std::errc{} && stop == end) return success();
  return fail(ErrorCode::invalid_parameter, fmt::format("{} '{}' is not a number", option, text));
}

}  // namespace

void MapOptions::add_to(CLI::App& app) {
  app.add_option("--map", map, "map file: .bt, .ot, .pcd, .ply, .3dmap (default: a made world)");
  app.add_option("--unknown", unknown, "space never measured: occupied (default), blocked, free");
  app.add_option("--v-max", v_max, "[m/s] speed limit (default 2)");
  app.add_option("--a-max", a_max, "[m/s^2] acceleration limit (default 2)");
  app.add_option("--norm", norm,
                 "what the limits bound: euclidean (default), per_axis or horizontal_vertical");
  app.add_option("--v-max-vertical", v_max_vertical,
                 "[m/s] vertical speed limit, with --norm horizontal_vertical (default --v-max)");
  app.add_option(
      "--a-max-vertical", a_max_vertical,
      "[m/s^2] vertical acceleration limit, with --norm horizontal_vertical (default --a-max)");
  app.add_option("--j-max", j_max, "[m/s^3] limit of the jerk (default: none)");
  app.add_option("--radius", radius, "[m] radius of the vehicle (default 0.15)");
  app.add_option("--margin", margin, "[m] kept for the tracking error (default 0.05)");
  app.add_option("--resolution", resolution, "[m] voxel edge for clouds and .3dmap (default 0.2)");
  app.add_option("--params-file", params_files, "ROS style parameter file; may repeat");
}

runtime::RosArgs MapOptions::ros_args(const std::string& map_file) const {
  runtime::RosArgs args;
  args.params_files = params_files;
  const auto set = [&](const char* name, const std::string& value) {
    if (!value.empty()) args.overrides.push_back({"map_server", name, value});
  };
  set("map_file", map_file);
  set("unknown", unknown);
  set("radius_m", radius);
  set("margin_m", margin);
  set("resolution_m", resolution);
  return args;
}

Result<Limits> MapOptions::limits(const Limits& defaults) const {
  Limits limits = defaults;
  if (auto s = read_number(v_max, "--v-max", limits.v_max_m_s); !s) return s.error();
  if (auto s = read_number(a_max, "--a-max", limits.a_max_m_s2); !s) return s.error();
  if (auto s = read_number(j_max, "--j-max", limits.j_max_m_s3); !s) return s.error();
  if (auto s = read_number(v_max_vertical, "--v-max-vertical", limits.v_max_vertical_m_s); !s) {
    return s.error();
  }
  if (auto s = read_number(a_max_vertical, "--a-max-vertical", limits.a_max_vertical_m_s2); !s) {
    return s.error();
  }
  if (norm.empty()) return limits;
  const auto known = from_word<LimitNorm>(norm);
  if (!known) {
    return fail(ErrorCode::invalid_parameter,
                fmt::format("--norm '{}': use {}", norm, fmt::join(all_words<LimitNorm>(), ", ")));
  }
  limits.norm = *known;
  return limits;
}

Result<std::string> save_default_world(const std::string& folder) {
  const auto world = worlds::make_world(worlds::default_world());
  if (!world) return world.error();
  const std::string file = folder + "/world.bt";
  const auto saved = map_server::save_voxels(world->geometry, world->occupied, {}, file);
  if (!saved) return saved.error();
  return file;
}

}  // namespace goshawk::cli
