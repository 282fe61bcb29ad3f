#include <cstdio>
#include <filesystem>

#include "goshawk/core/inflation.hpp"
#include "goshawk/map_server/map_file.hpp"
#include "goshawk/map_server/octree.hpp"
#include "goshawk/map_server/voxel_map.hpp"
#include "goshawk/worlds/world.hpp"
#include "verbs.hpp"

namespace goshawk::cli {
namespace {

struct WorldOptions {
  worlds::WorldSpec spec = worlds::default_world();
  std::string size;
  std::string origin;
  std::vector<std::string> keep_free;
  std::string convert;
  std::string output;
  bool json = false;
};

struct Made {
  GridGeometry geometry;
  BitGrid occupied;
  BitGrid known;  // empty: all
  std::string kind;
};

Status read_points(WorldOptions& o) {
  const auto read = [](const std::string& text, Vec3& out) -> Status {
    if (text.empty()) return success();
    auto point = parse_point(text);
    if (!point) return point.error();
    out = *point;
    return success();
  };
  if (auto s = read(o.size, o.spec.size_m); !s) return s;
  if (auto s = read(o.origin, o.spec.origin_m); !s) return s;
  // The default world keeps its start and goal free and is padded for them; another size has
  // neither unless asked for.
  if (!o.size.empty() || !o.keep_free.empty()) o.spec.keep_free.clear();
  if (!o.size.empty() && o.origin.empty()) o.spec.origin_m = Vec3::Zero();
  for (const auto& text : o.keep_free) {
    o.spec.keep_free.emplace_back();
    if (auto s = read(text, o.spec.keep_free.back()); !s) return s;
  }
  return success();
}

Result<Made> make(const WorldOptions& o) {
  if (o.convert.empty()) {
    auto world = worlds::make_world(o.spec);
    if (!world) return world.error();
    return Made{world->geometry, std::move(world->occupied), {}, o.spec.kind};
  }
  map_server::LoadOptions options;
  options.resolution_m = o.spec.resolution_m;
  auto source = map_server::load_map(o.convert, options);
  if (!source) return source.error();
  auto raw = map_server::voxelize(*source->tree);
  if (!raw) return raw.error();
  return Made{raw->geometry, std::move(raw->occupied), std::move(raw->known), source->format};
}

Json describe(const Made& made, const WorldOptions& o, double grown_ratio) {
  const auto& g = made.geometry;
  const double voxels = double(made.occupied.voxels());
  return {{"ok", true},
          {"code", "ok"},
          {"message", ""},
          {"file", o.output},
          {"kind", made.kind},
          {"seed", o.convert.empty() ? Json(o.spec.seed) : Json(nullptr)},
          {"resolution_m", g.resolution_m},
          {"size_voxels", {g.size.x, g.size.y, g.size.z}},
          {"origin_m", to_json(g.origin_map)},
          {"upper_m", to_json(g.upper_corner_map())},
          {"occupied_voxels", made.occupied.count()},
          {"occupied_ratio", double(made.occupied.count()) / voxels},
          {"inflation_m", o.spec.inflation_m},
          {"grown_ratio", grown_ratio}};
}

int run(WorldOptions& o) {
  if (auto s = read_points(o); !s) return report_failure(s.error(), o.json, kWrongCall);
  const auto made = make(o);
  if (!made) {
    const bool wrong = made.code() == ErrorCode::invalid_parameter;
    return report_failure(made.error(), o.json, wrong ? kWrongCall : kNotDone);
  }
  const auto grown = inflate(made->occupied, o.spec.inflation_m, made->geometry.resolution_m);
  if (!grown) return report_failure(grown.error(), o.json, kWrongCall);
  const auto saved = map_server::save_voxels(made->geometry, made->occupied, made->known, o.output);
  if (!saved) return report_failure(saved.error(), o.json, kNotDone);
  const double ratio = double(grown->count()) / double(grown->voxels());
  if (o.json) {
    print_json(describe(*made, o, ratio));
  } else {
    std::printf("%s: %s voxels of %g m, %lld occupied, %.1f %% blocked when grown by %g m\n",
                o.output.c_str(), to_text(made->geometry.size).c_str(), made->geometry.resolution_m,
                static_cast<long long>(made->occupied.count()), 100.0 * ratio, o.spec.inflation_m);
  }
  return kDone;
}

}  // namespace

int world_command(const Arguments& arguments) {
  CLI::App app(
      "Make a world from a few numbers, or convert a map. The same call gives the same "
      "bytes on every machine.",
      "goshawk world");
  app.footer(
      "Examples:\n"
      "  goshawk world forest.bt --kind forest --size 20,20,5 --density 0.2 --seed 7\n"
      "  goshawk world office.bt --convert scan.pcd --resolution 0.1");
  WorldOptions o;
  app.add_option("output", o.output, "file to write: .bt or .ot")->required();
  app.add_option("--kind", o.spec.kind, "boxes, forest, office or noise")->capture_default_str();
  app.add_option("--size", o.size, "x,y,z [m] (default: the padded 6 x 8 x 4 m world)");
  app.add_option("--origin", o.origin, "x,y,z [m] of the lower corner");
  app.add_option("--resolution", o.spec.resolution_m, "[m] voxel edge")->capture_default_str();
  app.add_option("--density", o.spec.density,
                 "share that is blocked: of the grown map, for noise of the voxels themselves")
      ->capture_default_str();
  app.add_option("--seed", o.spec.seed, "same seed, same world")
      ->capture_default_str()
      ->check(not_negative());
  app.add_option("--inflation", o.spec.inflation_m, "[m] growth that the density refers to")
      ->capture_default_str();
  app.add_option("--keep-free", o.keep_free, "x,y,z [m] that stays free when grown; may repeat");
  app.add_option("--convert", o.convert, "convert this map (.bt .ot .pcd .ply .3dmap) instead");
  app.add_flag("--json", o.json, "print one JSON object (docs/cli.md)");
  if (const auto status = parse(app, arguments)) return *status;
  return run(o);
}

}  // namespace goshawk::cli
