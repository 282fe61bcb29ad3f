#pragma once

#include <Eigen/Core>

#include "goshawk/core/vector.hpp"
#include "obstacle_boxes.hpp"

namespace goshawk::corridor_builder {

using Mat3 = Eigen::Matrix3d;

/// {x : (x - center)' metric (x - center) <= 1}, metric symmetric positive definite.
struct Ellipsoid {
  Vec3 center = Vec3::Zero();
  Mat3 metric = Mat3::Identity();
};

struct Nearest {
  Vec3 offset = Vec3::Zero();  // from the centre of the ellipsoid
  double squared = 0.0;        // offset' metric offset; below 1 inside the ellipsoid
};

/// The point of a box that is nearest to the ellipsoid's centre in its metric: a quadratic
/// programme in three bounded unknowns, solved exactly by its active bounds.
/// @param lower, upper corners of the box
Nearest nearest_in_box(const Ellipsoid& ellipsoid, const Vec3& lower, const Vec3& upper);

/// A lower bound of nearest_in_box().squared for a fraction of its cost: by convexity the metric
/// lies above its tangent at the box's Euclidean nearest point.
double squared_at_least(const Ellipsoid& ellipsoid, const Vec3& lower, const Vec3& upper);

/// The thesis' first ellipsoid: the segment pq is its main axis; the second semi-axis is as long
/// as obstacles let a spheroid's be, the third as long as they let it be then; none exceeds half
/// the segment. Where obstacles come nearer than 0.05 voxel edges the axis stays there, and the
/// ellipsoid is a measure of distance only.
/// @param p, q may be equal: then it is a small sphere
Ellipsoid shrink_around_segment(const Vec3& p, const Vec3& q, const BoxSet& boxes);

}  // namespace goshawk::corridor_builder
