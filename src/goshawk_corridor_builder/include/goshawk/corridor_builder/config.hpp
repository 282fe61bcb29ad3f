#pragma once

#include <concepts>
#include <type_traits>

#include "goshawk/core/parameter.hpp"
#include "goshawk/corridor_builder/choices.hpp"

namespace goshawk::corridor_builder {

/// What shapes a corridor. Lengths are in metres, waypoint clearance in voxel edges.
struct Config {
  Generator generator = Generator::ellipsoid;
  Margin margin = Margin::grown_grid;
  double local_box_m = 2.0;    // how far a polytope may reach sideways of its segment
  double max_segment_m = 8.0;  // longer segments are split into equal parts
  int expansion_passes = 3;    // most expansions anew from the inscribed ellipsoid
  int max_faces = 64;          // a polytope with more is built again in a smaller box
  bool bend_path = true;       // away from obstacles that it grazes
  double waypoint_clearance_voxels =
      1.0;                   // how far inner waypoints keep from faces, if there is room
  bool drop_covered = true;  // leave polytopes out whose neighbours meet without them
  double horizon_m = 0.0;    // of the path that a corridor is built for; 0: all of it
};

template <typename Self, typename Visitor>
requires std::same_as<std::remove_const_t<Self>, Config>
void describe(Self& config, Visitor&& visit) {
  visit(
      "generator", config.generator, "",
      "ellipsoid: expansion of an ellipsoid, largest polytopes; box: axis-aligned boxes, cheapest",
      AtRunTime{Anything{}});
  visit("margin", config.margin, "",
        "how the vehicle's size is kept: grown_grid (planes before the grown voxels) or sphere "
        "(planes that a sphere of the same radius touches before the voxels as they are: larger "
        "corridors; generator ellipsoid only)",
        Anything{});
  visit("local_box_m", config.local_box_m, "m",
        "how far a polytope may reach beyond the axis-aligned box of its segment",
        AtRunTime{Range{0.0, 100.0, true}});
  visit("max_segment_m", config.max_segment_m, "m",
        "path segments longer than this are split into equal parts",
        AtRunTime{Range{0.01, 1000.0}});
  visit("expansion_passes", config.expansion_passes, "",
        "how often, at most, a polytope is built anew around its inscribed ellipsoid; it ends "
        "early if that has hardly grown",
        AtRunTime{Range{0.0, 10.0}});
  visit("max_faces", config.max_faces, "",
        "a polytope with more faces is built again in a local box of half the reach, at most "
        "three times; the one with the fewest faces is taken",
        AtRunTime{Range{6.0, 1000.0}});
  visit("bend_path", config.bend_path, "",
        "bend the path away from obstacles that it grazes, so that consecutive polytopes share a "
        "ball of half a voxel (ellipsoid)",
        AtRunTime{Anything{}});
  visit("waypoint_clearance_voxels", config.waypoint_clearance_voxels, "voxel",
        "how far inner waypoints keep from the faces of their polytopes, if there is room",
        AtRunTime{Range{0.0, 100.0}});
  visit("drop_covered", config.drop_covered, "",
        "leave out polytopes whose neighbours share a ball that is as good without them",
        AtRunTime{Anything{}});
  visit(
      "horizon_m", config.horizon_m, "m",
      "a path that is longer than this by a fifth gets a corridor, and so a plan, for its first "
      "part of this length alone; the navigator plans on before it ends there. For a vehicle that "
      "plans at the rate of its map; 0: the whole path",
      AtRunTime{Range{0.0, 1e4}});
}

}  // namespace goshawk::corridor_builder
