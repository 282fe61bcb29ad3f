#pragma once

#include <span>
#include <vector>

#include "goshawk/core/result.hpp"
#include "goshawk/core/vector.hpp"

namespace goshawk {

/// A convex polytope {p : A p <= b}, frame `map`.
struct Polytope {
  using Normals = Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor>;

  Normals A;          // m x 3 outward unit normals
  Eigen::VectorXd b;  // [m] m offsets

  int faces() const { return int(b.size()); }
  void add(const Vec3& outward_normal, double offset_m);

  /// @return [m] the largest A p - b: negative inside (minus the distance to the nearest face),
  /// positive outside; NaN where the point or any face is NaN. @pre faces() > 0
  double violation(const Vec3& p_map) const {
    return (A.lazyProduct(p_map) - b).maxCoeff<Eigen::PropagateNaN>();
  }

  /// Sizes agree, everything finite, normals of unit length.
  Status check() const;

  static Polytope box(const Vec3& lower_map, const Vec3& upper_map);
};

struct Ball {
  Vec3 center_map = Vec3::Zero();  // [m]
  double radius_m = 0.0;           // [m] negative where there is no common point: by how much
};

/// The largest ball inside the intersection of one or two polytopes (a linear programme in four
/// unknowns, solved by the simplex method; deterministic, nothing allocated).
/// An unbounded polytope gives a ball of some 1e6 m; one that is not finite, or whose sizes
/// disagree, a radius of minus infinity. The ball is inside even after rounding.
Ball chebyshev_ball(const Polytope& polytope);
Ball chebyshev_ball(const Polytope& a, const Polytope& b);

/// A polytope's faces where they lie in memory: normal i is normals[3 i .. 3 i + 2].
struct HalfSpaces {
  const double* normals = nullptr;
  const double* offsets = nullptr;  // [m]
  int count = 0;
};
/// The same for the intersection of any number of polytopes.
Ball chebyshev_ball(std::span<const HalfSpaces> polytopes);

/// What a corridor builder hands to a trajectory optimizer: polytope k holds the segment from
/// waypoint k to waypoint k + 1.
struct Corridor {
  std::vector<Vec3> waypoints_map;      // [m] n + 1: start, joints, goal
  std::vector<Polytope> polytopes;      // n
  std::vector<Ball> overlaps;           // n - 1: largest ball shared by polytopes k and k + 1
  double min_overlap_radius_m() const;  // [m] infinity for one polytope, NaN if one is

  /// n >= 1, sizes agree, polytopes valid, overlaps finite, waypoints inside the polytopes they
  /// belong to.
  Status check() const;
};

}  // namespace goshawk
