#pragma once

#include <utility>
#include <vector>

#include "goshawk/core/polytope.hpp"

namespace goshawk::visualization {

/// The corners of one face, counter-clockwise seen from outside. Frame `map`, [m].
using Polygon = std::vector<Vec3>;

/// @param extent_m [m] faces are cut off this far from the plane's foot near the origin
/// @return one polygon for each face that bounds the polytope; redundant planes have none, and an
/// empty polytope has none at all. @pre polytope.check() ok
std::vector<Polygon> face_polygons(const Polytope& polytope, double extent_m = 1e4);

/// A closed surface: faces share their corners, and each edge belongs to two faces, once in each
/// direction. Frame `map`, [m].
struct Mesh {
  std::vector<Vec3> corners;
  std::vector<std::vector<std::size_t>> faces;  // counter-clockwise seen from outside
};

/// The polygons joined: corners nearer to each other than a micrometre are one, and what has no
/// three corners then is no face.
/// @return an empty mesh for an empty polytope. @pre polytope.check() ok
Mesh closed_mesh(const Polytope& polytope);

/// The mesh's edges, each once: indices of its two corners, the smaller one first.
std::vector<std::pair<std::size_t, std::size_t>> edges(const Mesh& mesh);

/// @return the corners of the convex hull, counter-clockwise (Andrew's monotone chain, 1979);
/// fewer than three if the points are fewer or all on a line
std::vector<Eigen::Vector2d> convex_hull(std::vector<Eigen::Vector2d> points);

}  // namespace goshawk::visualization
