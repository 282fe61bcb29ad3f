#pragma once

#include <span>
#include <vector>

#include "goshawk/core/half_space.hpp"
#include "goshawk/core/result.hpp"

namespace goshawk {

/// A convex polytope, the intersection of half-spaces, and when it is free of obstacles.
/// Frame `map`.
struct Polytope {
  using Normals = Eigen::Map<const Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor>,
                             Eigen::Unaligned, Eigen::OuterStride<4>>;
  using Offsets = Eigen::Map<const Eigen::VectorXd, Eigen::Unaligned, Eigen::InnerStride<4>>;

  std::vector<HalfSpace> half_spaces;
  // [s] after the start of the trajectory that uses it; both 0: always.
  double valid_from_s = 0.0;
  double valid_until_s = 0.0;

  int faces() const { return int(half_spaces.size()); }
  bool always_valid() const { return valid_from_s == 0.0 && valid_until_s == 0.0; }
  void add(const Vec3& outward_normal, double offset_m) {
    half_spaces.push_back({outward_normal, offset_m});
  }

  /// {p : A p <= b}, as views that hold as long as the half-spaces stay where they are.
  Normals A() const { return {numbers(), faces(), 3}; }   // m x 3 outward unit normals
  Offsets b() const { return {numbers() + 3, faces()}; }  // [m] m offsets

  /// @return [m] the largest A p - b: negative inside (minus the distance to the nearest face),
  /// positive outside; NaN if the point or any face is NaN. @pre faces() > 0
  double violation(const Vec3& p_map) const;

  /// At least one face, everything finite, normals of unit length; an interval that ends after it
  /// begins.
  Status check() const;

  static Polytope box(const Vec3& lower_map, const Vec3& upper_map);
  friend bool operator==(const Polytope&, const Polytope&) = default;

 private:
  static constexpr double kNone[4] = {};
  const double* numbers() const {
    return half_spaces.empty() ? kNone : half_spaces.front().normal.data();
  }
};

struct Ball {
  Vec3 center_map = Vec3::Zero();  // [m]
  double radius_m = 0.0;           // [m] negative if there is no common point: by how much
};

/// The largest ball inside the intersection of polytopes (a linear programme in four unknowns,
/// solved by the simplex method; deterministic, nothing allocated).
/// An unbounded polytope gives a ball of some 1e6 m; one that is not finite a radius of minus
/// infinity. The ball is inside even after rounding.
Ball chebyshev_ball(const Polytope& polytope);
Ball chebyshev_ball(const Polytope& a, const Polytope& b);
Ball chebyshev_ball(std::span<const std::span<const HalfSpace>> polytopes);

/// What a corridor builder hands to a trajectory optimizer: polytope k holds the segment from
/// waypoint k to waypoint k + 1.
struct Corridor {
  std::vector<Vec3> waypoints_map;      // [m] n + 1: start, points shared by neighbours, goal
  std::vector<Polytope> polytopes;      // n
  std::vector<Ball> overlaps;           // n - 1: largest ball shared by polytopes k and k + 1
  double min_overlap_radius_m() const;  // [m] infinity for one polytope, NaN if one is

  /// n >= 1, sizes agree, polytopes valid, overlaps finite, waypoints inside the polytopes they
  /// belong to.
  Status check() const;
};

}  // namespace goshawk
