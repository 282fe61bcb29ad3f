#include "joint_relaxation.hpp"

#include <algorithm>
#include <limits>
#include <utility>

namespace goshawk::corridor_builder {

void JointRelaxation::relax(const VoxelGrid& grid, double wanted_m, const Margins& margins,
                            SegmentPolytope& builder, Chain& chain, std::vector<Ball>& overlaps) {
  const std::size_t n = chain.polytopes.size();
  joints_map_ = chain.joints_map;
  narrow_.assign(n, 0);
  for (std::size_t k = 0; k < overlaps.size(); ++k) {
    if (overlaps[k].radius_m >= wanted_m || !(overlaps[k].radius_m > 1e-6)) continue;
    joints_map_[k + 1] = overlaps[k].center_map;
    narrow_[k] = narrow_[k + 1] = 1;
  }
  for (std::size_t begin = 0; begin < n;) {
    std::size_t end = begin;
    while (end < n && narrow_[end]) ++end;
    if (end > begin && rebuild(grid, begin, end, margins, builder, chain)) {
      exchange(begin, end, chain, overlaps);
    }
    begin = std::max(end, begin + 1);
  }
}

bool JointRelaxation::rebuild(const VoxelGrid& grid, std::size_t begin, std::size_t end,
                              const Margins& margins, SegmentPolytope& builder,
                              const Chain& chain) {
  rebuilt_.resize(chain.polytopes.size());
  for (std::size_t k = begin; k < end; ++k) {
    const Vec3 p = grid.geometry.to_grid(joints_map_[k]);
    const Vec3 q = grid.geometry.to_grid(joints_map_[k + 1]);
    if (builder.build(grid, p, q, margins, rebuilt_[k])) return false;
  }
  return true;
}

void JointRelaxation::exchange(std::size_t begin, std::size_t end, Chain& chain,
                               std::vector<Ball>& overlaps) {
  const std::size_t first = begin == 0 ? 0 : begin - 1;  // overlaps that change: first .. last - 1
  const std::size_t last = std::min(end, overlaps.size());
  auto now = [&](std::size_t k) -> const Polytope& {
    return k >= begin && k < end ? rebuilt_[k] : chain.polytopes[k];
  };
  auto least = [&](const std::vector<Ball>& balls) {
    double radius_m = std::numeric_limits<double>::infinity();
    for (std::size_t k = first; k < last; ++k) radius_m = std::min(radius_m, balls[k].radius_m);
    return radius_m;
  };
  balls_ = overlaps;
  for (std::size_t k = first; k < last; ++k) balls_[k] = chebyshev_ball(now(k), now(k + 1));
  if (!(least(balls_) > least(overlaps))) return;
  std::swap(overlaps, balls_);
  for (std::size_t k = begin; k < end; ++k) std::swap(chain.polytopes[k], rebuilt_[k]);
  for (std::size_t k = begin; k <= end; ++k) chain.joints_map[k] = joints_map_[k];
}

}  // namespace goshawk::corridor_builder
