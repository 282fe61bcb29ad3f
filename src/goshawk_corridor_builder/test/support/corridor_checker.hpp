#pragma once

#include <span>
#include <string>
#include <vector>

#include "goshawk/core/grid_geometry.hpp"
#include "goshawk/core/polytope.hpp"

namespace goshawk::corridor_builder::test_support {

/// The corners of {p : A p <= b}, by trying every three planes; shares no code with the builder.
std::vector<Vec3> vertices_of(const Polytope& polytope);

/// Do the open interiors of a polytope and of a cube meet? All corners of what they have in
/// common are found; if it has an interior, their mean lies in it.
bool interiors_meet(const Polytope& polytope, const Vec3& lower, const Vec3& upper);

/// Does a polytope's interior meet an occupied cube, or is it unbounded?
bool cuts_into_a_voxel(const Polytope& polytope, const VoxelGrid& grid);

/// The least distance between a polytope and a box, by trying every pair of their corners, edges
/// and faces; 0 if they meet.
double distance_to_box(const Polytope& polytope, const Vec3& lower, const Vec3& upper);

/// Looks for a set voxel within `radius_m` of a polytope. @return empty, or what is wrong
std::string sphere_faults(const Polytope& polytope, const BitGrid& raw,
                          const GridGeometry& geometry, double radius_m);

/// The volume, by integrating over a fine grid of lines along x; within a few per cent.
double volume_of(const Polytope& polytope);

/// Everything that a corridor promises, checked from its numbers alone.
/// @return empty, or what is wrong
std::string faults_of(const Corridor& corridor, const VoxelGrid& grid,
                      std::span<const Vec3> path_map);

}  // namespace goshawk::corridor_builder::test_support
