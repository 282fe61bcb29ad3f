#include "flight/preparation.hpp"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <filesystem>

#include "goshawk/map_server/octree.hpp"
#include "goshawk/worlds/world.hpp"

namespace goshawk::cli {
namespace {

const Vec3 kDefaultStart_map(3.0, 0.0, 1.0);
const Vec3 kDefaultGoal_map(3.0, 8.0, 2.0);

worlds::WorldSpec world_of(const FlyOptions& o) {
  auto spec = worlds::default_world();
  spec.seed = o.world_seed;
  if (o.world_density) spec.density = *o.world_density;
  return spec;
}

Result<Tour> make_tour(const FlyOptions& o, const PlanningConfig& config, const LoadedMap& map) {
  if (o.random > 0) {
    auto search = path_search::PathSearch::create(config.search);
    if (!search) return search.error();
    return random_tour(map.grown, *search, o.random, o.seed, o.min_distance_m);
  }
  if (!config.needs_world() && (!o.start_map || o.goals_map.empty())) {
    return fail(ErrorCode::invalid_parameter,
                "a map of your own needs --start x,y,z and --goal x,y,z, or --random N");
  }
  Tour tour{o.start_map.value_or(kDefaultStart_map), o.goals_map};
  if (tour.goals_map.empty()) tour.goals_map = {kDefaultGoal_map};
  // A vehicle that stands in a wall cannot even hover.
  auto located = locate(*map.grown, tour.start_map, Endpoint::start);
  if (!located) return located.error();
  return tour;
}

std::string dated_folder() {
  const std::string name =
      fmt::format("flights/{:%Y-%m-%d_%H-%M-%S}", fmt::localtime(std::time(nullptr)));
  std::string folder = name;
  for (int n = 2; std::filesystem::exists(folder); ++n) folder = fmt::format("{}_{}", name, n);
  return folder;
}

}  // namespace

Result<Preparation> prepare(const FlyOptions& o) {
  const Limits limits = o.map.limits();
  if (auto status = limits.check(); !status) return status.error();
  if (!(o.timeout_s > 0.0)) {
    return fail(ErrorCode::invalid_parameter, "--timeout must be above 0");
  }
  auto config = PlanningConfig::read(o.map.ros_args());
  if (!config) return config.error();
  auto map = load_map(*config, world_of(o));
  if (!map) return map.error();
  auto tour = make_tour(o, *config, *map);
  if (!tour) return tour.error();
  return Preparation{*std::move(config), *std::move(map), *std::move(tour), limits};
}

Result<std::string> make_flight_folder(const FlyOptions& o, const Preparation& p) {
  const std::string folder = o.folder.empty() ? dated_folder() : o.folder;
  std::error_code error;
  std::filesystem::create_directories(folder + "/logs", error);
  if (error) {
    return fail(ErrorCode::io_failed,
                fmt::format("the flight folder {} cannot be made: {}", folder, error.message()));
  }
  if (auto saved = map_server::save_voxels(p.map.raw.geometry, p.map.raw.occupied, p.map.raw.known,
                                           folder + "/world.bt");
      !saved) {
    return saved.error();
  }
  return std::filesystem::canonical(folder).string();
}

std::vector<std::string> launch_arguments(const FlyOptions& o, const Preparation& p,
                                          const std::string& folder) {
  std::vector<std::string> a{o.launch, "--log-dir", folder + "/logs", "--ros-args"};
  const auto set = [&](const std::string& name, const std::string& value) {
    a.insert(a.end(), {"-p", name + ":=" + value});
  };
  for (const auto& file : o.map.params_files) {
    a.insert(a.end(), {"--params-file", std::filesystem::absolute(file).string()});
  }
  for (const auto& override : o.map.ros_args().overrides) {
    if (override.name != "map_file") set(override.node + ":" + override.name, override.value);
  }
  set("map_server:map_file", p.config.needs_world()
                                 ? folder + "/world.bt"
                                 : std::filesystem::absolute(p.config.map.map_file).string());
  if (p.config.map.unknown == map_server::UnknownPolicy::free) {
    // Asked for, of a map that does not change: what was not measured is flown through.
    for (const char* node : {"navigator", "tracker"}) {
      set(fmt::format("{}:fly_unknown", node), "true");
    }
  }
  for (int axis = 0; axis < 3; ++axis) {
    set(fmt::format("simulator:start_{}_m", "xyz"[axis]),
        fmt::format("{:.17g}", p.tour.start_map[axis]));
  }
  for (const auto& [name, value] : {std::pair{"v_max_m_s", o.map.v_max_m_s},
                                    {"a_max_m_s2", o.map.a_max_m_s2},
                                    {"v_max_vertical_m_s", o.map.v_max_vertical_m_s},
                                    {"a_max_vertical_m_s2", o.map.a_max_vertical_m_s2},
                                    {"j_max_m_s3", o.map.j_max_m_s3}}) {
    if (value) set(fmt::format("navigator:{}", name), fmt::format("{}", *value));
  }
  if (!o.map.norm.empty()) set("navigator:limit_norm", o.map.norm);
  for (const auto& parameter : o.stage_parameters) a.insert(a.end(), {"-p", parameter});
  return a;
}

}  // namespace goshawk::cli
