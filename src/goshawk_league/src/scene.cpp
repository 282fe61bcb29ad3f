#include "goshawk/league/scene.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "goshawk/core/inflation.hpp"
#include "goshawk/sensors/solid_world.hpp"
#include "scene_parts.hpp"

namespace goshawk::league {
namespace {

// Does a solid reach into the inside of a cube?
bool reaches_into(const Solid& solid, const Vec3& lower, const Vec3& upper) {
  const Vec3 half = 0.5 * solid.size_m;
  const Vec3 lo = solid.center_map - half, hi = solid.center_map + half;
  if ((lo.array() >= upper.array()).any() || (hi.array() <= lower.array()).any()) return false;
  if (solid.is_box) return true;
  const Vec3 off = solid.center_map - solid.center_map.cwiseMax(lower).cwiseMin(upper);
  return off.head<2>().norm() < half.x();
}

void rasterize(const Solid& solid, const GridGeometry& geometry, BitGrid& raw) {
  const Vec3 half = 0.5 * solid.size_m;
  const Vec3 lo = geometry.to_grid(solid.center_map - half);
  const Vec3 hi = geometry.to_grid(solid.center_map + half);
  const auto from = [](double v) { return std::max(0, int(std::floor(v))); };
  const auto to = [](double v, int size) { return std::min(size - 1, int(std::floor(v))); };
  for (int z = from(lo.z()); z <= to(hi.z(), geometry.size.z); ++z) {
    for (int y = from(lo.y()); y <= to(hi.y(), geometry.size.y); ++y) {
      for (int x = from(lo.x()); x <= to(hi.x(), geometry.size.x); ++x) {
        const Vec3 lower = geometry.lower_corner({x, y, z});
        const Vec3 upper = lower + Vec3::Constant(geometry.resolution_m);
        if (reaches_into(solid, lower, upper)) raw.set({x, y, z}, true);
      }
    }
  }
}

}  // namespace

const std::vector<std::string>& scene_names() {
  static const std::vector<std::string> names{"standardized", "forest_easy", "forest_medium",
                                              "forest_hard",  "forest_300m", "thin_5",
                                              "thin_10",      "exits",       "office"};
  return names;
}

Result<Scene> make_scene(const std::string& name, std::uint64_t seed) {
  if (name == "standardized") return standardized(seed);
  if (name == "forest_easy") return sando(name, 0.05, seed);
  if (name == "forest_medium") return sando(name, 0.1, seed);
  if (name == "forest_hard") return sando(name, 0.2, seed);
  if (name == "forest_300m") return mighty(seed);
  if (name == "thin_5") return dynus(name, 5.0, seed);
  if (name == "thin_10") return dynus(name, 10.0, seed);
  if (name == "exits") return exits(seed);
  if (name == "office") return office(seed);
  return fail(ErrorCode::invalid_parameter,
              fmt::format("no world of the league is called '{}': use one of {}", name,
                          fmt::join(scene_names(), ", ")));
}

Limits per_axis(double v_m_s, double a_m_s2, double j_m_s3) {
  return {
      .v_max_m_s = v_m_s, .a_max_m_s2 = a_m_s2, .norm = LimitNorm::per_axis, .j_max_m_s3 = j_m_s3};
}

Solid ground_below(const map_server::Box& box) {
  constexpr double kBelow_m = 0.1, kThick_m = 1.0;
  Vec3 lower = box.lower_map, upper = box.upper_map;
  upper.z() = lower.z() - kBelow_m;
  lower.z() = upper.z() - kThick_m;
  const Vec3 aside(10.0, 10.0, 0.0);
  return box_between(lower - aside, upper + aside);
}

Result<std::shared_ptr<const sensors::World>> to_sensor_world(const std::vector<Solid>& solids) {
  std::vector<sensors::Solid> seen;
  for (const Solid& s : solids) {
    seen.push_back({s.is_box ? sensors::Solid::Kind::box : sensors::Solid::Kind::cylinder,
                    s.center_map, Quaternion::Identity(), 0.5 * s.size_m});
  }
  auto world = sensors::SolidWorld::create(std::move(seen));
  if (!world) return world.error();
  return std::shared_ptr<const sensors::World>(
      std::make_shared<const sensors::SolidWorld>(*std::move(world)));
}

Result<std::shared_ptr<const VoxelGrid>> known_map(const Scene& scene, double resolution_m,
                                                   double inflation_m) {
  constexpr std::int64_t kMostVoxels = 100'000'000;
  const auto geometry = map_server::raster_of(scene.box, resolution_m, kMostVoxels);
  if (!geometry) return geometry.error();
  BitGrid raw(geometry->size, true, false);
  for (const Solid& solid : scene.solids) rasterize(solid, *geometry, raw);
  auto grown = inflate(raw, inflation_m, resolution_m);
  if (!grown) return grown.error();
  return std::make_shared<const VoxelGrid>(VoxelGrid{.geometry = *geometry,
                                                     .grown = *std::move(grown),
                                                     .known = BitGrid(geometry->size, false, true),
                                                     .raw = std::move(raw),
                                                     .version = 1,
                                                     .inflation_m = inflation_m,
                                                     .unknown_is_occupied = false});
}

}  // namespace goshawk::league
