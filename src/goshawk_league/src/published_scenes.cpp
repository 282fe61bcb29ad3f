// Worlds that others have published, as their generators make them (docs/league.md has the
// sources).

#include "goshawk/worlds/cylinder_forest.hpp"
#include "scene_parts.hpp"

namespace goshawk::league {
namespace {

/// Seed 0 is the published world.
worlds::CylinderForest seeded(worlds::CylinderForest spec, std::uint64_t seed) {
  spec.seed = std::uint32_t(seed);
  return spec;
}

/// A forest from x = 0 to beyond its far edge. @param height_m up to which the map goes
Result<Scene> forest(const std::string& name, const worlds::CylinderForest& spec, double flight_m,
                     double flight_z_m, double height_m) {
  const auto trees = worlds::make_cylinders(spec);
  if (!trees) return trees.error();
  Scene scene;
  scene.name = name;
  scene.start = Vec3(0.0, 0.0, flight_z_m);
  scene.goal = Vec3(flight_m, 0.0, flight_z_m);
  scene.box = {Vec3(-2.0, spec.y_min_m - 1.0, 0.0),
               Vec3(flight_m + 2.0, spec.y_max_m + 1.0, height_m)};
  for (const auto& t : *trees) {
    scene.solids.push_back(column(t.x_m, t.y_m, t.radius_m, 0.0, t.height_m));
  }
  scene.solids.push_back(ground_below(scene.box));
  return scene;
}

}  // namespace

// Three columns; the goals lie side by side behind them.
Result<Scene> standardized(std::uint64_t seed) {
  constexpr std::uint64_t kGoals = 61;
  Scene scene;
  scene.name = "standardized";
  scene.box = {Vec3(-5.0, -5.0, 0.0), Vec3(5.0, 5.0, 2.0)};
  scene.solids = {column(-1.0, 2.0, 0.5, -0.15, 2.95), column(-1.0, -2.0, 0.5, -0.15, 2.95),
                  column(1.0, 0.0, 0.5, -0.15, 2.95), ground_below(scene.box)};
  scene.start = Vec3(-3.0, 0.0, 1.0);
  scene.goal = Vec3(3.5, -3.0 + 0.1 * double(seed % kGoals), 1.0);
  scene.limits = per_axis(1.0, 2.0, 3.0);
  scene.longest_s = 60.0;
  return scene;
}

Result<Scene> sando(const std::string& name, double density, std::uint64_t seed) {
  auto scene = forest(name, seeded(worlds::sando_forest(density), seed), 105.0, 2.0, 6.0);
  if (scene) scene->limits = per_axis(5.0, 20.0, 100.0);
  return scene;
}

Result<Scene> mighty(std::uint64_t seed) {
  auto scene = forest("forest_300m", seeded(worlds::mighty_forest(), seed), 305.0, 3.0, 6.0);
  if (!scene) return scene;
  scene->limits = per_axis(4.0, 10.0, 30.0);
  scene->longest_s = 300.0;
  return scene;
}

// Trees of all heights: the map ends where the highest may, so that no way leads over all of them.
Result<Scene> dynus(const std::string& name, double v_m_s, std::uint64_t seed) {
  auto scene = forest(name, seeded(worlds::dynus_forest(0.05), seed), 105.0, 3.0, 5.0);
  if (scene) scene->limits = per_axis(v_m_s, 20.0, 30.0);
  return scene;
}

}  // namespace goshawk::league
