#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "goshawk/core/grid_geometry.hpp"
#include "goshawk/core/limits.hpp"
#include "goshawk/flight_check/flight_check.hpp"
#include "goshawk/map_server/octree.hpp"
#include "goshawk/sensors/world.hpp"

namespace goshawk::league {

using Solid = flight_check::Solid;

/// A true world, and the flight that is to be made through it. Frame map [m].
struct Scene {
  std::string name;
  std::vector<Solid> solids;
  map_server::Box box;  // what the map covers; its faces are as good as obstacles for the centre
  Vec3 start = Vec3::Zero();
  Vec3 goal = Vec3::Zero();
  Limits limits;
  double longest_s = 100.0;  // then the flight has failed
};

/// "standardized", "forest_easy", ... in the order of the table
const std::vector<std::string>& scene_names();

/// @param seed which of its goals or worlds; of a published forest, 0 is the published one
/// @return invalid_parameter for another name
Result<Scene> make_scene(const std::string& name, std::uint64_t seed);

/// The world as a sensor sees it.
Result<std::shared_ptr<const sensors::World>> to_sensor_world(const std::vector<Solid>& solids);

/// The map of a vehicle that knows the world: a voxel is an obstacle if a solid reaches into its
/// inside. @return map_too_large
Result<std::shared_ptr<const VoxelGrid>> known_map(const Scene& scene, double resolution_m,
                                                   double inflation_m);

}  // namespace goshawk::league
