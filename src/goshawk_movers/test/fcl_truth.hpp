#pragma once

#include <fcl/geometry/shape/box.h>
#include <fcl/geometry/shape/sphere.h>
#include <fcl/narrowphase/distance.h>

#include <numbers>

#include "goshawk/core/random.hpp"
#include "goshawk/movers/oriented_box.hpp"

namespace goshawk::movers {

inline Vec3 random_vector(Random& random, double most) {
  const double x = random.uniform(-most, most), y = random.uniform(-most, most);
  return {x, y, random.uniform(-most, most)};
}

inline Quaternion random_turn(Random& random) {
  const Vec3 axis = random_vector(random, 1.0).normalized();
  const double angle = random.uniform(-std::numbers::pi, std::numbers::pi);
  return Quaternion(Eigen::Quaterniond(Eigen::AngleAxisd(angle, axis)));
}

inline OrientedBox random_box(Random& random) {
  const Vec3 half = Vec3::Constant(1.1) + random_vector(random, 1.0);
  return {random_vector(random, 3.0), random_turn(random), half};
}

/// [m] between a box and a ball, by FCL; below 0 if they touch.
inline double fcl_distance_m(const OrientedBox& box, const Vec3& center_map, double radius_m) {
  const fcl::Box<double> shape(2.0 * box.half_m.x(), 2.0 * box.half_m.y(), 2.0 * box.half_m.z());
  fcl::Transform3<double> pose = fcl::Transform3<double>::Identity();
  pose.linear() = box.q_map_box.toRotationMatrix();
  pose.translation() = box.center_map;
  fcl::Transform3<double> place = fcl::Transform3<double>::Identity();
  place.translation() = center_map;
  const fcl::Sphere<double> ball(radius_m);
  const fcl::DistanceRequest<double> request(true, false, 0.0, 0.0, 1e-6,
                                             fcl::GJKSolverType::GST_INDEP);
  fcl::DistanceResult<double> result;
  fcl::distance(&shape, pose, &ball, place, request, result);
  return result.min_distance;
}

}  // namespace goshawk::movers
