#include "segment_polytope.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "inscribed_ellipsoid.hpp"

namespace goshawk::corridor_builder {
namespace {

constexpr int kHalvings = 3;         // of the local box, for max_faces
constexpr double kWorthwhile = 1.2;  // a further pass must begin with an ellipsoid so much larger

// Up to a factor.
double volume_of(const Ellipsoid& ellipsoid) {
  return 1.0 / std::sqrt(ellipsoid.metric.determinant());
}

// At least half a voxel: the balls around the ends of the segment lie inside.
VoxelBox local_box(const Index3& size, const Segment& segment, double wanted_reach) {
  const double reach = std::max(0.5, wanted_reach);
  const Vec3 lower = segment.p.cwiseMin(segment.q);
  const Vec3 upper = segment.p.cwiseMax(segment.q);
  auto first = [&](int a, int n) {
    return int(std::clamp(std::floor(lower[a] - reach), 0.0, double(n - 1)));
  };
  auto last = [&](int a, int n, int begin) {
    return int(std::clamp(std::ceil(upper[a] + reach), double(begin + 1), double(n)));
  };
  VoxelBox box;
  box.lo = {first(0, size.x), first(1, size.y), first(2, size.z)};
  box.hi = {last(0, size.x, box.lo.x), last(1, size.y, box.lo.y), last(2, size.z, box.lo.z)};
  return box;
}

VoxelBox widened(const VoxelBox& box, int by, const Index3& size) {
  return {{std::max(0, box.lo.x - by), std::max(0, box.lo.y - by), std::max(0, box.lo.z - by)},
          {std::min(size.x, box.hi.x + by), std::min(size.y, box.hi.y + by),
           std::min(size.z, box.hi.z + by)}};
}

}  // namespace

Separation SegmentPolytope::build(const ObstacleLayers& map, const Segment& segment,
                                  bool stop_when_thin, const Margins& margins, Polytope& polytope) {
  double reach = config_.local_box_m / map.geometry.resolution_m;
  fewest_.clear();
  Separation result = Separation::roomy;
  for (int k = 0; k <= kHalvings; ++k, reach *= 0.5) {
    result = build_within(map, segment, reach, stop_when_thin, margins);
    if (result == Separation::blocked) return result;
    if (result == Separation::thin && stop_when_thin) return result;
    if (fewest_.empty() || faces_.size() < fewest_.size()) {
      std::swap(fewest_, faces_);
      fewest_base_ = base_;
    }
    if (int(fewest_.size()) <= config_.max_faces) break;
  }
  to_map(fewest_, fewest_base_, map.geometry, polytope);
  return result;
}

Separation SegmentPolytope::build_within(const ObstacleLayers& map, const Segment& segment,
                                         double reach_voxels, bool stop_when_thin,
                                         const Margins& margins) {
  const VoxelBox local = local_box(map.geometry.size, segment, reach_voxels);
  const Index3 size = local.hi - local.lo;
  const Vec3 extent(size.x, size.y, size.z);
  base_ = Vec3(local.lo.x, local.lo.y, local.lo.z);
  Segment here = segment;
  here.p -= base_;
  here.q -= base_;
  collect(map, local);
  if (stop_when_thin && find_thin(here)) return Separation::thin;

  const Ellipsoid first = shrink_around_segment(here.p, here.q, boxes_);
  const auto [separation, at] =
      expansion_.expand(first, boxes_, extent, here, stop_when_thin, margins);
  in_the_way_ = at;
  if (separation == Separation::blocked) return separation;
  if (separation == Separation::thin && stop_when_thin) return separation;
  grow(first, extent, here, margins);
  redundancy_.filter(expansion_.planes(), extent, margins, faces_);
  return separation;
}

// Looks for an obstacle that the segment passes, but not with its balls.
bool SegmentPolytope::find_thin(const Segment& segment) {
  for (std::size_t i = 0; i < boxes_.size(); ++i) {
    const Obstacle obstacle = boxes_.at(i);
    if (!meets(obstacle, segment, segment.needed)) continue;
    if (!(clearance(obstacle, segment, {}) > 0.0)) return false;  // perhaps it is blocked
    in_the_way_ = obstacle;
    return true;
  }
  return false;
}

// Obstacles beyond the local box may reach into it by their sphere.
void SegmentPolytope::collect(const ObstacleLayers& map, const VoxelBox& local) {
  boxes_.clear();
  for (const auto& [voxels, radius] : map.layers) {
    if (voxels.empty()) continue;
    const int beyond = int(std::min(1e6, std::ceil(radius)));
    merger_.collect(voxels, widened(local, beyond, map.geometry.size), local.lo, radius, boxes_);
  }
}

void SegmentPolytope::grow(const Ellipsoid& first, const Vec3& extent, const Segment& segment,
                           const Margins& margins) {
  Ellipsoid ellipsoid = first;
  for (int pass = 0; pass < config_.expansion_passes; ++pass) {
    Ellipsoid grown;
    if (!grow_inscribed_ellipsoid(expansion_.planes(), ellipsoid, grown)) return;
    if (pass > 0 && volume_of(grown) < kWorthwhile * volume_of(ellipsoid)) return;
    const auto result = again_.expand(grown, boxes_, extent, segment, false, margins);
    if (result.separation == Separation::blocked) return;
    expansion_.swap_planes(again_);
    ellipsoid = grown;
  }
}

void to_map(const std::vector<Plane>& planes, const Vec3& base, const GridGeometry& geometry,
            Polytope& polytope) {
  polytope.half_spaces.clear();
  for (const Plane& plane : planes) {
    polytope.add(plane.normal, geometry.resolution_m * (plane.offset + plane.normal.dot(base)) +
                                   plane.normal.dot(geometry.origin_map));
  }
}

}  // namespace goshawk::corridor_builder
