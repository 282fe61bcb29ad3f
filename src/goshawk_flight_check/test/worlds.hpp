#pragma once

#include <octomap/octomap.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <vector>

#include "goshawk/core/random.hpp"
#include "goshawk/flight_check/flight_check.hpp"

namespace goshawk::flight_check::test {

inline constexpr double kVoxel_m = 0.1;

/// A tree whose voxels [i, i + 1] * 0.1 m are occupied where listed.
inline std::unique_ptr<octomap::OcTree> tree_of(const std::vector<Index3>& voxels) {
  auto tree = std::make_unique<octomap::OcTree>(kVoxel_m);
  for (const Index3& i : voxels) {
    tree->updateNode(octomap::point3d(float((i.x + 0.5) * kVoxel_m), float((i.y + 0.5) * kVoxel_m),
                                      float((i.z + 0.5) * kVoxel_m)),
                     true);
  }
  return tree;
}

inline std::vector<Index3> wall_at_x(int x, int half_width) {
  std::vector<Index3> voxels;
  for (int y = -half_width; y < half_width; ++y) {
    for (int z = -half_width; z < half_width; ++z) voxels.push_back({x, y, z});
  }
  return voxels;
}

inline Sample at(double t_s, const Vec3& position_map,
                 const Eigen::Quaterniond& q = Eigen::Quaterniond::Identity()) {
  return {t_s, position_map, q};
}

inline Eigen::Quaterniond turn(double angle_rad, const Vec3& axis) {
  return Eigen::Quaterniond(Eigen::AngleAxisd(angle_rad, axis.normalized()));
}

struct Bracket {
  double at_least_m = 0.0;
  double at_most_m = std::numeric_limits<double>::infinity();
};

/// Brackets the distance between a cylinder and a voxel. Projecting onto the one and the other in
/// turn converges to the nearest pair of two convex sets (Cheney and Goldstein, 1959), from above;
/// the gap along the line between the two projections is a bound from below.
inline Bracket cylinder_to_voxel(const Sample& s, const Body& body, const Index3& voxel) {
  const Vec3 lower = kVoxel_m * Vec3(voxel.x, voxel.y, voxel.z);
  const Vec3 upper = lower.array() + kVoxel_m;
  const Eigen::Quaterniond back = s.q_map_base.conjugate();
  Bracket bracket;
  Vec3 p = s.position_map;
  for (int i = 0; i < 100000 && bracket.at_most_m - bracket.at_least_m > 1e-6; ++i) {
    const Vec3 in_box = p.cwiseMax(lower).cwiseMin(upper);
    Vec3 q = back * (in_box - s.position_map);
    const double across = std::hypot(q.x(), q.y());
    if (across > body.radius_m) q.head<2>() *= body.radius_m / across;
    q.z() = std::clamp(q.z(), -body.height_m / 2.0, body.height_m / 2.0);
    p = s.position_map + s.q_map_base * q;
    bracket.at_most_m = std::min(bracket.at_most_m, (p - in_box).norm());
    const Vec3 along = (p - in_box).stableNormalized();
    const Vec3 n = back * along;
    const double cylinder_m = along.dot(s.position_map) - body.radius_m * n.head<2>().norm() -
                              body.height_m / 2.0 * std::abs(n.z());
    const double box_m = along.cwiseMax(0.0).dot(upper) + along.cwiseMin(0.0).dot(lower);
    bracket.at_least_m = std::max(bracket.at_least_m, cylinder_m - box_m);
  }
  return bracket;
}

inline Bracket brute_force(const Sample& s, const Body& body, const std::vector<Index3>& voxels) {
  Bracket nearest{.at_least_m = std::numeric_limits<double>::infinity()};
  for (const Index3& v : voxels) {
    const Vec3 center = kVoxel_m * (Vec3(v.x, v.y, v.z).array() + 0.5).matrix();
    const double far_m = (center - s.position_map).norm() - body.reach_m() - kVoxel_m;
    if (far_m > nearest.at_most_m) continue;
    const Bracket here = cylinder_to_voxel(s, body, v);
    nearest.at_least_m = std::min(nearest.at_least_m, here.at_least_m);
    nearest.at_most_m = std::min(nearest.at_most_m, here.at_most_m);
  }
  return nearest;
}

inline Verdict judge(std::unique_ptr<octomap::OcTree> tree, const std::vector<Sample>& track,
                     const Body& body = {}, const Options& options = {}) {
  return FlightCheck::from_tree(std::move(tree), body, options).value().judge(track).value();
}

}  // namespace goshawk::flight_check::test
