#include <fmt/format.h>

#include <filesystem>

#include "flight/random_tour.hpp"
#include "goshawk/map_server/octree.hpp"
#include "goshawk/runtime/component.hpp"
#include "planning/planning.hpp"
#include "values.hpp"
#include "verbs/verbs.hpp"

namespace goshawk::cli {
namespace {

/// What launch.py asks for: which map its map server gets, and where its simulated vehicle begins.
struct PlaceOptions {
  std::string map_server = "map_server";  // node
  std::string plant;                      // node; empty: there is none
  std::string map;                        // as the caller asked for; empty: he did not
  std::optional<Vec3> start_map;
  std::string world;  // file for a made world, if nothing names a map
  Words ros_args;     // of the map server and the plant
};

/// Parameters to add, "node:name" to value, and a sentence that says so.
struct Placed {
  Json parameters = Json::object();
  std::string message;
};

/// A place from which others can be reached.
Result<Vec3> free_place(const LoadedMap& map) {
  constexpr double kAway_m = 1.0;
  auto search = path_search::PathSearch::create({});
  if (!search) return search.error();
  const auto tour = random_tour(map.grown, *search, 1, 1, kAway_m);
  if (!tour) {
    return fail(tour.code(), fmt::format("no free place was found for the vehicle: name one with "
                                         "--start ({})",
                                         tour.error().message));
  }
  return tour->start_map;
}

Status add_start(const PlaceOptions& o, const LoadedMap& map, Placed& placed) {
  Vec3 start_map;
  if (o.start_map) {
    start_map = *o.start_map;
    if (auto located = locate(*map.grown, start_map, Endpoint::start); !located) {
      return located.error();
    }
  } else {
    const auto place = free_place(map);
    if (!place) return place.error();
    start_map = *place;
  }
  for (int axis = 0; axis < 3; ++axis) {
    placed.parameters[fmt::format("{}:start_{}_m", o.plant, "xyz"[axis])] =
        fmt::format("{}", start_map[axis]);
  }
  placed.message += fmt::format("; the vehicle begins at {:g},{:g},{:g}", start_map.x(),
                                start_map.y(), start_map.z());
  return success();
}

/// Whether the vehicle's place is given by parameters already.
bool has_start(const runtime::RosArgs& args, const std::string& plant) {
  const auto source = args.parameters_of(plant);
  return source && source->entries().contains("start_x_m");
}

Result<Placed> place(const PlaceOptions& o) {
  Words words{"--ros-args"};
  words.insert(words.end(), o.ros_args.begin(), o.ros_args.end());
  const auto args = runtime::RosArgs::extract(words);
  if (!args) return fail(ErrorCode::invalid_parameter, args.error().message);
  const auto source = args->parameters_of(o.map_server);
  if (!source) return fail(ErrorCode::invalid_parameter, source.error().message);
  auto read = runtime::read_parameters<map_server::Config>(*source, o.map_server);
  if (!read) return read.error();
  PlanningConfig config;
  config.map = *std::move(read);
  if (!o.map.empty()) config.map.map_file = std::filesystem::absolute(o.map).string();

  Placed placed;
  const bool made = config.needs_world();
  const bool asked = !o.map.empty() || o.start_map.has_value();
  if (!made && !asked) return placed;
  const auto map = load_map(config);
  if (!map) return map.error();
  if (made) {
    if (auto saved =
            map_server::save_voxels(map->raw.geometry, map->raw.occupied, map->raw.known, o.world);
        !saved)
      return saved.error();
    config.map.map_file = o.world;
  }
  placed.parameters[o.map_server + ":map_file"] = config.map.map_file;
  placed.message = fmt::format("map {}{}", config.map.map_file, made ? ", a made world" : "");
  // The made world is free where a simulated vehicle begins by default.
  const bool choose = !o.map.empty() && !o.plant.empty() && !has_start(*args, o.plant);
  if (o.start_map || choose) {
    if (auto added = add_start(o, *map, placed); !added) return added.error();
  }
  return placed;
}

int run_place(const PlaceOptions& o, const Console& console) {
  const auto placed = place(o);
  if (!placed) return console.failed(placed.error());
  Json object = ok_json();
  object["message"] = placed->message;
  object["parameters"] = placed->parameters;
  console.print_line(object);
  return kDone;
}

}  // namespace

void add_place(Program& program) {
  const Verb verb = program.verb("place", "the map and the start of a launch (for launch.py)");
  verb->group("");  // not for people
  auto o = std::make_shared<PlaceOptions>();
  verb->add_option("--map-server", o->map_server, "its node");
  verb->add_option("--plant", o->plant, "its node");
  verb->add_option("--map", o->map, "map file");
  add_point(verb, "--start", o->start_map, "[m] where the vehicle begins");
  verb->add_option("--world", o->world, "file for a made world, if nothing names a map");
  verb.takes_ros_args(o->ros_args);
  verb.runs([o](const Console& console) { return run_place(*o, console); });
}

}  // namespace goshawk::cli
