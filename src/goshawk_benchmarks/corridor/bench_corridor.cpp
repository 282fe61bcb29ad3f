// Corridors: time a segment, and what it buys, beside ellipsoid decomposition on voxel centres.

#include <algorithm>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "common/measure.hpp"
#include "common/report.hpp"
#include "corridor/ellipsoid_decomposition.hpp"
#include "corridor/quality.hpp"
#include "corridor/scenes.hpp"
#include "goshawk/corridor_builder/corridor_builder.hpp"
#include "support/corridor_checker.hpp"

namespace goshawk::bench {
namespace {

using corridor_builder::Config;
using corridor_builder::CorridorBuilder;
namespace check = corridor_builder::test_support;

constexpr double kWhole_m = 1000.0;  // segments are not split: the baseline does not either

struct WorldClass {
  std::string name;
  std::string kind;
  Vec3 size_m;
  double density;
};

struct Segment {
  const Scene* scene;
  std::vector<Vec3> ends_map;
};

/// One way to wrap a segment.
struct Generator {
  std::string name;
  std::optional<CorridorBuilder> builder;  // none: the baseline
  bool sphere = false;
  Planes planes = Planes::through_centres;
  Corridor corridor = {};  // the last answer, reused

  void run(const Segment& s) {
    const VoxelGrid& grid = *s.scene->grid;
    if (!builder) {
      const double reach_m = Config{}.local_box_m;
      corridor.waypoints_map = s.ends_map;
      corridor.polytopes = {decompose(grid, s.ends_map[0], s.ends_map[1], reach_m, planes)};
      corridor.overlaps.clear();
      return;
    }
    const auto status = builder->build(grid, s.ends_map, corridor);
    if (!status) throw std::runtime_error(name + ": " + status.error().message);
  }
};

CorridorBuilder builder_of(const Config& config) {
  return std::move(CorridorBuilder::create(config)).value();
}

std::vector<Generator> generators() {
  std::vector<Generator> all;
  all.push_back({"ellipsoid", builder_of({.max_segment_m = kWhole_m})});
  all.push_back(
      {"ellipsoid, no growth", builder_of({.max_segment_m = kWhole_m, .expansion_passes = 0})});
  all.push_back(
      {"sphere",
       builder_of({.margin = corridor_builder::Margin::sphere, .max_segment_m = kWhole_m}), true});
  all.push_back({"box", builder_of({.generator = corridor_builder::Generator::box})});
  all.push_back({"decomposition", std::nullopt});
  all.push_back({"decomposition, cleared", std::nullopt, false, Planes::before_cubes});
  return all;
}

/// What one generator's polytopes are worth, over all segments.
struct Quality {
  std::vector<double> volume_m3, stolen_m3, radius_m, faces;
  int overlapping = 0;
  int lost = 0;  // segments that are not inside

  void add(const Generator& g, const Segment& s) {
    const VoxelGrid& grid = *s.scene->grid;
    for (const Polytope& polytope : g.corridor.polytopes) {
      const Volume volume = volume_of(polytope, grid);
      volume_m3.push_back(volume.total_m3);
      stolen_m3.push_back(volume.stolen_m3);
      radius_m.push_back(chebyshev_ball(polytope).radius_m);
      faces.push_back(faces_of(polytope));
      overlapping +=
          g.sphere
              ? !check::sphere_faults(polytope, grid.raw, grid.geometry, grid.inflation_m).empty()
              : check::cuts_into_a_voxel(polytope, grid);
    }
    lost += g.corridor.polytopes.front().violation(s.ends_map[0]) > 1e-9 ||
            g.corridor.polytopes.back().violation(s.ends_map[1]) > 1e-9;
  }
};

std::vector<Segment> segments_of(const std::vector<Scene>& scenes, std::size_t most) {
  std::vector<Segment> segments;
  for (const Scene& scene : scenes) {
    for (const auto& path : scene.paths_map) {
      for (std::size_t i = 0; i + 1 < path.size(); ++i) {
        segments.push_back({&scene, {path[i], path[i + 1]}});
      }
    }
  }
  // Evenly from all worlds.
  std::vector<Segment> chosen;
  const std::size_t n = std::min(most, segments.size());
  for (std::size_t k = 0; k < n; ++k) chosen.push_back(segments[k * segments.size() / n]);
  return chosen;
}

void measure_segments(Report& report, const WorldClass& world, const std::vector<Scene>& scenes) {
  const bool quick = report.options().quick;
  const auto segments = segments_of(scenes, quick ? 40 : 150);
  std::vector<Generator> all = generators();
  std::vector<Timing> timings(all.size());
  std::vector<Quality> quality(all.size());
  for (const Segment& segment : segments) {
    std::vector<Contender> contenders;
    for (Generator& g : all) contenders.push_back({g.name, [&] { g.run(segment); }});
    const auto taken = compare("segment", contenders, quick ? 5 : 15);
    for (std::size_t i = 0; i < all.size(); ++i) {
      timings[i].append(taken[i]);
      quality[i].add(all[i], segment);
    }
  }
  const double baseline_us = timings[4].median_us();
  for (std::size_t i = 0; i < all.size(); ++i) {
    Quality& q = quality[i];
    report.add({{"table", "segments"},
                {"world", world.name},
                {"density", world.density},
                {"generator", all[i].name},
                {"segments", segments.size()},
                {"median_us", timings[i].median_us()},
                {"p90_us", timings[i].p90_us()},
                {"times_faster", baseline_us / timings[i].median_us()},
                {"median_volume_m3", median(q.volume_m3)},
                {"median_stolen_m3", median(q.stolen_m3)},
                {"inscribed_radius_m", median(q.radius_m)},
                {"faces", median(q.faces)},
                {"overlapping_obstacles", q.overlapping},
                {"lost_segments", q.lost}});
  }
}

/// Whole paths: waypoints, bends and dropped polytopes included.
void measure_paths(Report& report, const WorldClass& world, const std::vector<Scene>& scenes) {
  const std::pair<std::string, Config> rows[] = {
      {"ellipsoid", {}},
      {"ellipsoid, path not bent", {.bend_path = false}},
      {"sphere", {.margin = corridor_builder::Margin::sphere}},
      {"box", {.generator = corridor_builder::Generator::box}}};
  for (const auto& [name, config] : rows) {
    CorridorBuilder builder = builder_of(config);
    Timing whole, shares;
    double slowest_us = 0.0;  // of the path that takes longest
    std::vector<double> radius_voxels;
    std::size_t segments = 0, polytopes = 0, below = 0;
    for (const Scene& scene : scenes) {
      for (const auto& path : scene.paths_map) {
        Corridor corridor;
        Status status = success();
        const auto run = [&] { status = builder.build(*scene.grid, path, corridor); };
        const Timing t = compare("path", {{name, run}}, report.options().quick ? 3 : 9)[0];
        if (!status) throw std::runtime_error(status.error().message);
        whole.append(t);
        slowest_us = std::max(slowest_us, t.median_us());
        Timing share = t;
        for (double& us : share.sorted_us) us /= double(path.size() - 1);
        shares.append(share);
        segments += path.size() - 1;
        polytopes += corridor.polytopes.size();
        for (const Ball& ball : corridor.overlaps) {
          const double r = ball.radius_m / scene.grid->geometry.resolution_m;
          radius_voxels.push_back(r);
          below += r < 0.5 * (1.0 - 1e-5);
        }
      }
    }
    report.add(
        {{"table", "paths"},
         {"world", world.name},
         {"density", world.density},
         {"generator", name},
         {"segments", segments},
         {"polytopes", polytopes},
         {"median_us_path", whole.median_us()},
         {"slowest_us_path", slowest_us},
         {"median_us", shares.median_us()},
         {"p90_us", shares.p90_us()},
         {"overlaps", radius_voxels.size()},
         {"overlaps_below_half_voxel", below},
         {"median_overlap_radius_voxels", radius_voxels.empty() ? 0.0 : median(radius_voxels)},
         {"least_overlap_radius_voxels",
          radius_voxels.empty() ? 0.0 : *std::ranges::min_element(radius_voxels)}});
  }
}

/// The same room in ever larger maps.
void measure_map_size(Report& report) {
  for (const double side_m : {10.0, 100.0, 1000.0}) {
    report.progress("map of " + std::to_string(int(side_m)) + " m");
    const Scene scene = room_in_a_map(side_m);
    CorridorBuilder builder = builder_of({});
    Corridor corridor;
    const auto run = [&] {
      if (!builder.build(*scene.grid, scene.paths_map[0], corridor)) {
        throw std::runtime_error("the room's path is blocked");
      }
    };
    const Timing t = compare("map", {{"ellipsoid", run}}, report.options().quick ? 50 : 300)[0];
    report.add({{"table", "map_size"},
                {"world", "room in a map"},
                {"density", 0.3},
                {"generator", "ellipsoid"},
                {"map_side_m", side_m},
                {"segments", scene.paths_map[0].size() - 1},
                {"median_us_path", t.median_us()},
                {"p90_us_path", t.p90_us()}});
  }
}

void draw(Report& report, const std::string& world, const std::string& file) {
  Plot plot{.x = "density",
            .x_label = "share of blocked voxels",
            .series = "generator",
            .where = {{"table", "segments"}, {"world", world}}};
  report.draw(plot.of(file + "_volume", "Volume of a polytope, " + world, "median_volume_m3",
                      "median [m3]"));
  plot.log_y = true;
  report.draw(plot.of(file + "_time", "Time for a segment, " + world, "median_us", "median [us]"));
  plot.log_y = false;
  plot.where["table"] = "paths";
  report.draw(plot.of(file + "_paths", "Time for a segment of a whole path, " + world, "median_us",
                      "median [us]"));
}

void run(Report& report) {
  const bool quick = report.options().quick;
  const std::string boxes = "boxes 6x8x4 m", forest = "forest 30x30x5 m";
  std::vector<WorldClass> worlds;
  for (const double d : {0.1, 0.2, 0.3, 0.4}) worlds.push_back({boxes, "boxes", {6, 8, 4}, d});
  for (const double d : {0.05, 0.1, 0.2, 0.3}) worlds.push_back({forest, "forest", {30, 30, 5}, d});
  for (const WorldClass& world : worlds) {
    report.progress(world.name + ", " + std::to_string(world.density));
    const auto scenes =
        make_scenes(world.kind, world.size_m, world.density, quick ? 3 : 8, quick ? 4 : 8);
    measure_segments(report, world, scenes);
    measure_paths(report, world, scenes);
  }
  measure_map_size(report);
  draw(report, boxes, "corridor_boxes");
  draw(report, forest, "corridor_forest");
  report.draw({.file = "corridor_map_size",
               .title = "Time for the same path in larger maps",
               .x = "map_side_m",
               .y = "median_us_path",
               .x_label = "side of the map [m]",
               .y_label = "median [us]",
               .series = "generator",
               .where = {{"table", "map_size"}},
               .log_x = true});
}

}  // namespace
}  // namespace goshawk::bench

int main(int argc, char** argv) {
  return goshawk::bench::bench_main(argc, argv, "corridor", goshawk::bench::run);
}
