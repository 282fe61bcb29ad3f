#pragma once

#include <concepts>
#include <string>
#include <type_traits>

#include "goshawk/core/parameter.hpp"

namespace goshawk::corridor_builder {

/// What shapes a corridor. Lengths are in metres, joint clearance in voxel edges.
struct Config {
  std::string generator = "ellipsoid";  // ellipsoid (largest) or box (axis-aligned, cheapest)
  double local_box_m = 2.0;             // how far a polytope may reach sideways of its segment
  double max_segment_m = 8.0;           // longer segments are split into equal parts
  int growth_passes = 1;                // re-inflations from the inscribed ellipsoid
  int max_faces = 64;                   // a polytope with more is built again in a smaller box
  int relax_passes = 1;                 // tries to widen overlaps that are narrower than wanted
  double wanted_overlap_voxels = 0.5;   // radius of the ball that neighbours should share
  double joint_clearance_voxels = 1.0;  // how far joints keep from faces, where there is room
  bool drop_covered = true;             // leave polytopes out whose neighbours meet without them
};

template <typename Self, typename Visitor>
requires std::same_as<std::remove_const_t<Self>, Config>
void describe(Self& config, Visitor&& visit) {
  visit(
      "generator", config.generator, "",
      "ellipsoid: inflation of an ellipsoid, largest polytopes; box: axis-aligned boxes, cheapest",
      OneOf{{"ellipsoid", "box"}});
  visit("local_box_m", config.local_box_m, "m",
        "how far a polytope may reach beyond the axis-aligned box of its segment",
        Range{0.0, 100.0, true});
  visit("max_segment_m", config.max_segment_m, "m",
        "path segments longer than this are split into equal parts", Range{0.01, 1000.0});
  visit("growth_passes", config.growth_passes, "",
        "how often a polytope is built anew around its inscribed ellipsoid (0: never)",
        Range{0.0, 10.0});
  visit("max_faces", config.max_faces, "",
        "a polytope with more faces is built again in a local box of half the reach, at most "
        "three times; the one with the fewest faces is taken",
        Range{6.0, 1000.0});
  visit("relax_passes", config.relax_passes, "",
        "how often polytopes with a narrow overlap are built anew around its centre (ellipsoid)",
        Range{0.0, 10.0});
  visit("wanted_overlap_voxels", config.wanted_overlap_voxels, "voxel",
        "overlaps whose largest ball has a smaller radius count as narrow", Range{0.0, 100.0});
  visit("joint_clearance_voxels", config.joint_clearance_voxels, "voxel",
        "how far joints between polytopes are kept from faces where there is room",
        Range{0.0, 100.0});
  visit("drop_covered", config.drop_covered, "",
        "leave out polytopes whose neighbours share a ball that is as good without them",
        Anything{});
}

}  // namespace goshawk::corridor_builder
