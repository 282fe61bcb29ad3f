#pragma once

#include <fcl/geometry/octree/octree.h>
#include <fcl/geometry/shape/shape_base.h>

#include <limits>
#include <memory>
#include <span>
#include <vector>

#include "goshawk/core/vehicle.hpp"
#include "goshawk/flight_check/body.hpp"
#include "goshawk/flight_check/solid.hpp"

namespace goshawk::flight_check {

inline constexpr double kInfinity = std::numeric_limits<double>::infinity();

struct Pose {
  Vec3 position_map = Vec3::Zero();
  Quaternion q_map_base = Quaternion::Identity();
};

struct Clearance {
  double distance_m = 0.0;  // [m] 0 in contact, infinity if there is no obstacle
  /// [m] nearest point of an obstacle; in contact where they meet, or the body's own position
  /// if FCL cannot say, or if there is no obstacle
  Vec3 obstacle_map = Vec3::Zero();
};

/// Distances between one body and the occupied leaves of one OctoMap, or some solids, by FCL.
class ClearanceMeter {
 public:
  /// FCL's own GJK overestimates the distance of a cylinder and a box by up to 1e-5 m; anything
  /// nearer than this counts as contact.
  static constexpr double kContact_m = 1e-4;

  /// @pre inner nodes of the tree are up to date; body.check() ok
  ClearanceMeter(std::shared_ptr<const octomap::OcTree> tree, const Body& body);
  /// @pre each solid's check() ok; body.check() ok
  ClearanceMeter(std::span<const Solid> solids, const Body& body);

  /// @param at_most_m [m] the clearance is known not to be larger: makes the search about
  /// ten times faster. A wrong bound costs time, never a wrong answer.
  Clearance measure(const Pose& pose,
                    double at_most_m = std::numeric_limits<double>::infinity()) const;

 private:
  struct Obstacle {
    std::shared_ptr<fcl::CollisionGeometry<double>> geometry;
    fcl::Transform3<double> pose;
    fcl::AABB<double> box;  // around it, in the map
  };
  void add(std::shared_ptr<fcl::CollisionGeometry<double>> geometry, const Vec3& place_map);
  Vec3 contact_map(const Obstacle& obstacle, const Pose& pose) const;

  std::vector<Obstacle> obstacles_;
  std::shared_ptr<fcl::ShapeBase<double>> body_;
};

}  // namespace goshawk::flight_check
