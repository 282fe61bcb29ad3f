#pragma once

#include <vector>

#include "chain.hpp"
#include "goshawk/core/grid_geometry.hpp"
#include "segment_polytope.hpp"

namespace goshawk::corridor_builder {

/// Widens narrow overlaps. A shortest path grazes obstacles, and a polytope around a grazing
/// segment is thin at its ends. Where two polytopes share less than is wanted, their joint moves to
/// the centre of what they share, and both are built anew around the segments that follow from
/// it: those lie inside the old polytopes, so they are free, and keep more distance.
class JointRelaxation {
 public:
  /// @param wanted_m [m] overlaps of this radius are left alone
  /// Neighbouring polytopes that were built anew replace the old ones together, and only where the
  /// least overlap among them has grown.
  void relax(const VoxelGrid& grid, double wanted_m, const Margins& margins,
             SegmentPolytope& builder, Chain& chain, std::vector<Ball>& overlaps);

 private:
  bool rebuild(const VoxelGrid& grid, std::size_t begin, std::size_t end, const Margins& margins,
               SegmentPolytope& builder, const Chain& chain);
  void exchange(std::size_t begin, std::size_t end, Chain& chain, std::vector<Ball>& overlaps);

  std::vector<Vec3> joints_map_;  // moved
  std::vector<unsigned char> narrow_;
  std::vector<Polytope> rebuilt_;
  std::vector<Ball> balls_;
};

}  // namespace goshawk::corridor_builder
