#pragma once

#include <memory>

#include "goshawk/core/bit_grid.hpp"
#include "goshawk/core/vector.hpp"

namespace goshawk::path_search {

/// What a sampling planner asks of a map: may the vehicle's centre move from a to b? Points in
/// [voxel units, GridGeometry::to_grid]; a == b asks for a point.
class SegmentValidity {
 public:
  virtual ~SegmentValidity() = default;
  virtual bool is_free(const Vec3& a, const Vec3& b) const = 0;
};

/// goshawk::line_is_free: exact, a walk through the grid. @param blocked must outlive the result
std::unique_ptr<SegmentValidity> make_grid_validity(const BitGrid& blocked);

/// The Flexible Collision Library (Pan, Chitta and Manocha, ICRA 2012): a capsule around the
/// segment against a tree of boxes, one for each run of blocked voxels, and six walls where what is
/// outside counts as blocked. The capsule is so thin that it only covers FCL's rounding: what it
/// calls free is free on the grid, and what keeps twice kFclMargin away is free here.
/// @param blocked is not kept
std::unique_ptr<SegmentValidity> make_fcl_validity(const BitGrid& blocked);
inline constexpr double kFclMargin = 1e-3;  // [voxels] radius of the capsule

}  // namespace goshawk::path_search
