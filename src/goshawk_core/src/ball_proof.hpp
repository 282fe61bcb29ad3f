#pragma once

#include <optional>

#include "goshawk/core/free_space.hpp"

namespace goshawk {

/// Keeps the vehicle's ball, around every point of a curve, out of the cubes that a map has as
/// raw obstacles, and of those that were never seen if that is asked for. Lengths are in voxels of
/// the grid.
///
/// A vehicle at rest may be nearer to some of them than its inflation, because the map learnt them
/// late. It may leave: of each such cube it keeps at least the distance that it has at rest.
class BallProof {
 public:
  using Points = Points3<6>;

  /// @param rest where the curve begins at rest; nothing: it does not
  /// @pre the space asks for raw voxels
  BallProof(const FreeSpace::View& space, double touch, const std::optional<Vec3>& rest);

  /// @return whether it is proved for the whole curve; false for one that must be halved first
  bool holds(const Points& curve) const;
  /// @return a cube that is too near to the point, or the voxel outside of the map that it is in
  std::optional<Index3> too_near(const Vec3& point) const;

 private:
  double least_distance(Index3 voxel) const;
  template <typename Visit>
  bool for_cubes_near(const Vec3& low, const Vec3& high, const Visit& visit) const;
  bool is_inside(const Vec3& low, const Vec3& high) const;

  FreeSpace::View space_;
  double touch_;
  double radius_;
  std::optional<Vec3> rest_;
};

}  // namespace goshawk
