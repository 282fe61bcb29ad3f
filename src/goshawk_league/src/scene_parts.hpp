#pragma once

#include "goshawk/league/scene.hpp"
#include "goshawk/worlds/world.hpp"

namespace goshawk::league {

inline Solid box_between(const Vec3& lower, const Vec3& upper) {
  return {.is_box = true, .center_map = 0.5 * (lower + upper), .size_m = upper - lower};
}
/// Upright. @param bottom_m, top_m heights of its ends
inline Solid column(double x_m, double y_m, double radius_m, double bottom_m, double top_m) {
  return {.center_map = Vec3(x_m, y_m, 0.5 * (bottom_m + top_m)),
          .size_m = Vec3(2.0 * radius_m, 2.0 * radius_m, top_m - bottom_m)};
}
/// The ground below a scene, half a voxel below the map's lower face: on it, it would flicker.
Solid ground_below(const map_server::Box& box);

/// The faces of a scene's box, as walls around it, and the ground.
void enclose(Scene& scene, double height_m);
/// A world's obstacles: runs of occupied voxels along x, joined over rows and layers that have the
/// same run. Shifted off the map's raster: walls on the faces of voxels would flicker between two.
std::vector<Solid> to_boxes(const worlds::World& world);

Limits per_axis(double v_m_s, double a_m_s2, double j_m_s3);

Result<Scene> standardized(std::uint64_t seed);
Result<Scene> sando(const std::string& name, double density, std::uint64_t seed);
Result<Scene> mighty(std::uint64_t seed);
Result<Scene> dynus(const std::string& name, double v_m_s, std::uint64_t seed);
Result<Scene> exits(std::uint64_t seed);
Result<Scene> office(std::uint64_t seed);

}  // namespace goshawk::league
