#include "clearance.hpp"

#include <fcl/geometry/shape/box.h>
#include <fcl/geometry/shape/cylinder.h>
#include <fcl/narrowphase/collision.h>
#include <fcl/narrowphase/distance.h>

namespace goshawk::flight_check {

namespace {

using Transform = fcl::Transform3<double>;

Transform transform(const Pose& pose) {
  Transform T_map_base = Transform::Identity();
  T_map_base.linear() = pose.q_map_base.toRotationMatrix();
  T_map_base.translation() = pose.position_map;
  return T_map_base;
}

std::shared_ptr<fcl::ShapeBase<double>> shape_of(const Body& body) {
  if (body.is_box) {
    return std::make_shared<fcl::Box<double>>(body.length_m, body.width_m, body.height_m);
  }
  return std::make_shared<fcl::Cylinder<double>>(body.radius_m, body.height_m);
}

std::shared_ptr<fcl::ShapeBase<double>> shape_of(const Solid& solid) {
  const Vec3& size = solid.size_m;
  if (solid.is_box) return std::make_shared<fcl::Box<double>>(size.x(), size.y(), size.z());
  return std::make_shared<fcl::Cylinder<double>>(size.x() / 2.0, size.z());
}

/// libccd, FCL's default, reported distances up to 4 cm too large for a cylinder beside a voxel;
/// FCL's own solver stayed within 1e-5 m of the truth on the same 20,000 poses.
constexpr auto kSolver = fcl::GJKSolverType::GST_INDEP;

}  // namespace

ClearanceMeter::ClearanceMeter(std::shared_ptr<const octomap::OcTree> tree, const Body& body)
    : body_(shape_of(body)) {
  body_->computeLocalAABB();
  const double occupied = tree->getOccupancyThres();
  auto obstacle = std::make_shared<fcl::OcTree<double>>(std::move(tree));
  // FCL has a threshold of its own; the map's is the one that counts.
  obstacle->setOccupancyThres(occupied);
  add(std::move(obstacle), Vec3::Zero());
}

ClearanceMeter::ClearanceMeter(std::span<const Solid> solids, const Body& body)
    : body_(shape_of(body)) {
  body_->computeLocalAABB();
  for (const Solid& solid : solids) add(shape_of(solid), solid.center_map);
}

void ClearanceMeter::add(std::shared_ptr<fcl::CollisionGeometry<double>> geometry,
                         const Vec3& place_map) {
  geometry->computeLocalAABB();
  const fcl::AABB<double> box = fcl::translate(geometry->aabb_local, fcl::Vector3d(place_map));
  Transform pose = Transform::Identity();
  pose.translation() = place_map;
  obstacles_.push_back({std::move(geometry), pose, box});
}

Clearance ClearanceMeter::measure(const Pose& pose, double at_most_m) const {
  const fcl::DistanceRequest<double> request(true, false, 0.0, 0.0, 1e-6, kSolver);
  fcl::DistanceResult<double> result;
  const double unlimited = result.min_distance;
  // What lies beyond min_distance is passed over, so the bound must leave some room.
  if (at_most_m < kInfinity) result.min_distance = at_most_m * 1.01 + 1e-3;
  const double bound = result.min_distance;
  const fcl::AABB<double> place{fcl::Vector3d(pose.position_map)};
  for (const Obstacle& obstacle : obstacles_) {
    if (place.distance(obstacle.box) - body_->aabb_radius > result.min_distance) continue;
    fcl::distance(obstacle.geometry.get(), obstacle.pose, body_.get(), transform(pose), request,
                  result);
    if (result.min_distance <= 0.0) return {0.0, contact_map(obstacle, pose)};
  }
  if (result.min_distance <= kContact_m) return {0.0, result.nearest_points[0]};
  if (result.min_distance < bound) return {result.min_distance, result.nearest_points[0]};
  if (bound < unlimited) return measure(pose);
  return {kInfinity, pose.position_map};
}

Vec3 ClearanceMeter::contact_map(const Obstacle& obstacle, const Pose& pose) const {
  fcl::CollisionRequest<double> request(1, true);
  request.gjk_solver_type = kSolver;
  fcl::CollisionResult<double> result;
  fcl::collide(obstacle.geometry.get(), obstacle.pose, body_.get(), transform(pose), request,
               result);
  if (result.numContacts() == 0 || !result.getContact(0).pos.allFinite()) return pose.position_map;
  return result.getContact(0).pos;
}

}  // namespace goshawk::flight_check
