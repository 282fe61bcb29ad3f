#include "flight/preparation.hpp"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <functional>

#include "goshawk/map_server/octree.hpp"
#include "goshawk/path_search/ends.hpp"
#include "goshawk/worlds/world.hpp"
#include "program.hpp"

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

// The parameters of the stages that plan, as the flight will have them.
Result<PlanningConfig> read_config(const FlyOptions& o) {
  Words words{"--ros-args"};
  for (const auto& parameter : o.stage_parameters) words.insert(words.end(), {"-p", parameter});
  const auto more = runtime::RosArgs::extract(words);
  if (!more) return fail(ErrorCode::invalid_parameter, more.error().message);
  runtime::RosArgs args = o.map.ros_args();
  args.overrides.insert(args.overrides.end(), more->overrides.begin(), more->overrides.end());
  return PlanningConfig::read(args);
}

// A vehicle that stands in a wall cannot even hover, and a goal that no plan can end at is told
// before anything starts. As the search would, a start is moved within move_within_m.
Status place_ends(const PlanningConfig& config, const VoxelGrid& grid, bool all_goals, Tour& tour,
                  std::vector<std::string>& notes) {
  const auto place = [&](const Vec3& p_map, Endpoint endpoint) {
    return path_search::place_end(grid, config.search.corner_rule, p_map, endpoint,
                                  config.search.move_within_m);
  };
  const auto start = place(tour.start_map, Endpoint::start);
  if (!start) return start.error();
  if (start->moved_m > 0.0) {
    notes.push_back(fmt::format("the vehicle begins at {}, {:.2f} m from {}, which is not free",
                                to_text(start->at_map), start->moved_m, to_text(tour.start_map)));
    tour.start_map = start->at_map;
  }
  for (const Vec3& goal : tour.goals_map) {
    if (const auto placed = place(goal, Endpoint::goal); !placed && all_goals) {
      return placed.error();
    }
  }
  return success();
}

/// In a live flight the faces of the world are walls, and the map ends a voxel before them.
std::shared_ptr<const VoxelGrid> within_faces(const VoxelGrid& world) {
  constexpr double kWall_m = 0.5;  // inflation, reserve, a voxel, and some for the sensor's noise
  auto grid = std::make_shared<VoxelGrid>(world);
  const Index3 size = grid->geometry.size;
  const int wall = int(std::ceil(kWall_m / grid->geometry.resolution_m));
  for (int z = 0; z < size.z; ++z) {
    for (int y = 0; y < size.y; ++y) {
      const bool outer = std::min({y, size.y - 1 - y, z, size.z - 1 - z}) < wall;
      grid->grown.set_run(0, outer ? size.x : std::min(wall, size.x), y, z, true);
      grid->grown.set_run(std::max(0, size.x - wall), size.x, y, z, true);
    }
  }
  return grid;
}

Result<Tour> make_tour(const FlyOptions& o, const PlanningConfig& config, const LoadedMap& map) {
  if (o.random > 0) {
    auto search = path_search::PathSearch::create(config.search);
    if (!search) return search.error();
    return random_tour(o.live ? within_faces(*map.grown) : map.grown, *search, o.random, o.seed,
                       o.min_distance_m);
  }
  if (!config.needs_world() && (!o.start_map || o.goals_map.empty())) {
    return fail(ErrorCode::invalid_parameter,
                "a map of your own needs --start x,y,z and --goal x,y,z, or --random N");
  }
  Tour tour{o.start_map.value_or(kDefaultStart_map), o.goals_map};
  if (tour.goals_map.empty()) tour.goals_map = {kDefaultGoal_map};
  return tour;
}

std::string dated_folder() {
  const std::string name =
      fmt::format("flights/{:%Y-%m-%d_%H-%M-%S}", fmt::localtime(std::time(nullptr)));
  std::string folder = name;
  for (int n = 2; std::filesystem::exists(folder); ++n) folder = fmt::format("{}_{}", name, n);
  return folder;
}

// The sensors see the world; the map server begins with nothing. Its box ends a voxel before the
// world: rays that leave the world meet its faces, which must not flicker at the map's border.
void add_live(const Preparation& p, const std::string& folder,
              const std::function<void(const std::string&, const std::string&)>& set) {
  set("lidar:world_file", folder + "/world.bt");
  const GridGeometry& world = p.map.raw.geometry;
  const Vec3 edge = Vec3::Constant(world.resolution_m);
  const Vec3 lower = world.origin_map + edge, upper = world.upper_corner_map() - edge;
  for (int axis = 0; axis < 3; ++axis) {
    set(fmt::format("map_server:box_{}_min_m", "xyz"[axis]), fmt::format("{:.9g}", lower[axis]));
    set(fmt::format("map_server:box_{}_max_m", "xyz"[axis]), fmt::format("{:.9g}", upper[axis]));
  }
}

void add_known(const Preparation& p, const std::string& folder,
               const std::function<void(const std::string&, const std::string&)>& set) {
  set("map_server:map_file", p.config.needs_world()
                                 ? folder + "/world.bt"
                                 : std::filesystem::absolute(p.config.map.map_file).string());
  if (p.config.map.unknown != map_server::UnknownPolicy::free) return;
  // Asked for, of a map that does not change: what was not measured is flown through.
  for (const char* node : {"navigator", "tracker"}) {
    set(fmt::format("{}:fly_unknown", node), "true");
  }
}

}  // namespace

Result<Preparation> prepare(const FlyOptions& o) {
  const Limits limits = o.map.limits();
  if (auto status = limits.check(); !status) return status.error();
  if (!(o.timeout_s > 0.0)) {
    return fail(ErrorCode::invalid_parameter, "--timeout must be above 0");
  }
  auto config = read_config(o);
  if (!config) return config.error();
  auto map = load_map(*config, world_of(o));
  if (!map) return map.error();
  auto tour = make_tour(o, *config, *map);
  if (!tour) return tour.error();
  std::vector<std::string> notes;
  for (const auto& note : map->notes) notes.push_back("map: " + note);
  if (auto status = place_ends(*config, *map->grown, !o.keep_going, *tour, notes); !status) {
    return status.error();
  }
  return Preparation{*std::move(config), *std::move(map), *std::move(tour), limits,
                     std::move(notes)};
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
  const std::string launch = o.launch.empty() ? (o.live ? "live" : "flight") : o.launch;
  std::vector<std::string> a{launch, "--log-dir", folder + "/logs", "--ros-args"};
  const auto set = [&](const std::string& name, const std::string& value) {
    a.insert(a.end(), {"-p", name + ":=" + value});
  };
  for (const auto& file : o.map.params_files) {
    a.insert(a.end(), {"--params-file", std::filesystem::absolute(file).string()});
  }
  for (const auto& override : o.map.ros_args().overrides) {
    if (override.name != "map_file") set(override.node + ":" + override.name, override.value);
  }
  o.live ? add_live(p, folder, set) : add_known(p, folder, set);
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
