#include <fmt/format.h>

#include <numbers>

#include "goshawk/core/inflation.hpp"
#include "goshawk/map_server/map_file.hpp"
#include "goshawk/map_server/map_summary.hpp"
#include "goshawk/map_server/octree.hpp"
#include "goshawk/map_server/voxel_map.hpp"
#include "goshawk/worlds/world.hpp"
#include "json.hpp"
#include "values.hpp"
#include "verbs/verbs.hpp"

namespace goshawk::cli {
namespace {

struct WorldOptions {
  worlds::WorldSpec spec = worlds::default_world();
  std::optional<Vec3> size_m;
  std::optional<Vec3> origin_m;
  std::vector<Vec3> keep_free;
  std::string convert;
  map_server::LoadOptions load;           // of the map to convert
  std::optional<Vec3> lower_m, upper_m;   // of the box that it is cut to
  Vec3 turn_deg = Vec3::Zero();
  std::string output;
};

struct Made {
  GridGeometry geometry;
  BitGrid occupied;
  BitGrid known;  // empty: all
  std::string kind;
  std::string read;  // of a converted map: what was read of it
};

/// The default world keeps its start and goal free and is padded for them; another size has neither
/// unless asked for.
worlds::WorldSpec spec_of(const WorldOptions& o) {
  worlds::WorldSpec spec = o.spec;
  if (o.size_m || !o.keep_free.empty()) spec.keep_free = o.keep_free;
  if (o.size_m) {
    spec.size_m = *o.size_m;
    spec.origin_m = Vec3::Zero();
  }
  if (o.origin_m) spec.origin_m = *o.origin_m;
  return spec;
}

Result<Made> convert(const WorldOptions& o, const Console& console) {
  map_server::LoadOptions options = o.load;
  options.resolution_m = o.spec.resolution_m;
  options.turn_rad = std::numbers::pi / 180.0 * o.turn_deg;
  if (o.lower_m.has_value() != o.upper_m.has_value()) {
    return fail(ErrorCode::invalid_parameter, "--lower and --upper make a box: give both");
  }
  if (o.lower_m) options.box = map_server::Box{*o.lower_m, *o.upper_m};
  auto source = map_server::load_map(o.convert, options);
  if (!source) return source.error();
  for (const std::string& note : source->notes) console.say(o.convert + ": " + note);
  auto raw = map_server::voxelize(*source, {.box = options.box});
  if (!raw) return raw.error();
  std::string read = map_server::summarise(*source, *raw);
  return Made{raw->geometry, std::move(raw->occupied), std::move(raw->known), source->format,
              std::move(read)};
}

Result<Made> make(const WorldOptions& o, const Console& console) {
  if (o.convert.empty()) {
    auto world = worlds::make_world(spec_of(o));
    if (!world) return world.error();
    return Made{world->geometry, std::move(world->occupied), {}, o.spec.kind, {}};
  }
  return convert(o, console);
}

Json describe(const Made& made, const WorldOptions& o, double grown_ratio) {
  const auto& g = made.geometry;
  const double voxels = double(made.occupied.voxels());
  Json object = ok_json();
  object.update({{"file", o.output},
                 {"kind", made.kind},
                 {"seed", o.convert.empty() ? Json(o.spec.seed) : Json(nullptr)},
                 {"read", made.read.empty() ? Json(nullptr) : Json(made.read)},
                 {"resolution_m", g.resolution_m},
                 {"size_voxels", {g.size.x, g.size.y, g.size.z}},
                 {"origin_m", to_json(g.origin_map)},
                 {"upper_m", to_json(g.upper_corner_map())},
                 {"occupied_voxels", made.occupied.count()},
                 {"occupied_ratio", double(made.occupied.count()) / voxels},
                 {"inflation_m", o.spec.inflation_m},
                 {"grown_ratio", grown_ratio}});
  return object;
}

int run_world(const WorldOptions& o, const Console& console) {
  const auto made = make(o, console);
  if (!made) return console.failed(made.error());
  const auto grown = inflate(made->occupied, o.spec.inflation_m, made->geometry.resolution_m);
  if (!grown) return console.wrong_call(grown.error());
  const auto saved = map_server::save_voxels(made->geometry, made->occupied, made->known, o.output);
  if (!saved) return console.not_done(saved.error());
  const double ratio = double(grown->count()) / double(grown->voxels());
  if (console.json()) {
    console.print(describe(*made, o, ratio));
  } else {
    if (!made->read.empty()) fmt::print("{}: {}\n", o.convert, made->read);
    fmt::print("{}: {} voxels of {:g} m, {} occupied, {:.1f} % blocked with an inflation of {:g} m\n",
               o.output, to_text(made->geometry.size), made->geometry.resolution_m,
               made->occupied.count(), 100.0 * ratio, o.spec.inflation_m);
  }
  return kDone;
}

void add_convert_options(const Verb& verb, WorldOptions& o) {
  add_point(verb, "--lower", o.lower_m, "[m] with --convert: lower corner of the box to cut to");
  add_point(verb, "--upper", o.upper_m, "[m] with --convert: its upper corner");
  verb->add_option("--scale", o.load.scale,
                   "[m] with --convert: a unit of the file's coordinates (0.001: millimetres)");
  add_point(verb, "--cloud-origin", o.load.origin_file,
            "[m] with --convert: subtracted from every point");
  add_point(verb, "--turn", o.turn_deg,
            "[degrees] with --convert: then turned about the map's x, y and z, in this order; 90,0,0 "
            "for a mesh whose y axis points up");
  verb->add_flag("--drop-outliers", o.load.drop_outliers,
                 "with --convert: leave out points far from all others, and voxels that touch no "
                 "other");
}

}  // namespace

void add_world(Program& program) {
  const Verb verb = program.verb(
      "world", "make a world from a few numbers, or convert a map; the same call, the same bytes");
  auto o = std::make_shared<WorldOptions>();
  verb->add_option("output", o->output, "file to write: .bt or .ot")->required();
  auto* kind = verb->add_option("--kind", o->spec.kind, "boxes, forest, office or noise")
                   ->capture_default_str();
  verb.completes(kind, [](const Words&) { return worlds::world_kinds(); });
  add_point(verb, "--size", o->size_m, "[m] (default: the padded 6 x 8 x 4 m world)");
  add_point(verb, "--origin", o->origin_m, "[m] lower corner");
  verb->add_option("--resolution", o->spec.resolution_m, "[m] voxel edge")->capture_default_str();
  verb->add_option("--density", o->spec.density,
                   "share that is blocked after inflation; noise: share of occupied voxels")
      ->capture_default_str();
  verb->add_option("--seed", o->spec.seed, "same seed, same world")
      ->capture_default_str()
      ->check(not_negative());
  verb->add_option("--inflation", o->spec.inflation_m, "[m] inflation that --density refers to")
      ->capture_default_str();
  add_points(verb, "--keep-free", o->keep_free,
             "[m] point that stays free after inflation; may repeat");
  verb->add_option("--convert", o->convert,
                   "convert this map instead: .bt, .ot, .pcd, .ply, .stl, .obj, .3dmap");
  add_convert_options(verb, *o);
  verb->footer(
      "Examples:\n"
      "  goshawk world forest.bt --kind forest --size 20,20,5 --density 0.2 --seed 7\n"
      "  goshawk world office.bt --convert scan.pcd --resolution 0.1 --drop-outliers\n"
      "  goshawk world hall.bt --convert hall.obj --scale 0.001 --turn 90,0,0");
  verb.runs([o](const Console& console) { return run_world(*o, console); });
}

}  // namespace goshawk::cli
