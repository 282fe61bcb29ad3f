#include "segment_polytope.hpp"

#include <algorithm>
#include <cmath>

#include "inscribed_ellipsoid.hpp"

namespace goshawk::corridor_builder {
namespace {

constexpr double kWantedSlack = 0.5;  // [voxel edges] planes keep this from both ends, if they can
constexpr int kHalvings = 3;          // of the local box, for max_faces

VoxelBox local_box(const BitGrid& grid, const Vec3& p, const Vec3& q, double reach) {
  const Vec3 lower = p.cwiseMin(q);
  const Vec3 upper = p.cwiseMax(q);
  const Index3 size = grid.size();
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

}  // namespace

std::optional<Vec3> SegmentPolytope::build(const VoxelGrid& grid, const Vec3& p, const Vec3& q,
                                           const Margins& margins, Polytope& polytope) {
  double reach = config_.local_box_m / grid.geometry.resolution_m;
  fewest_.clear();
  for (int k = 0; k <= kHalvings; ++k, reach *= 0.5) {
    if (auto blocked = build_within(grid, p, q, reach, margins)) return blocked;
    if (fewest_.empty() || faces_.size() < fewest_.size()) {
      std::swap(fewest_, faces_);
      fewest_base_ = base_;
    }
    if (int(fewest_.size()) <= config_.max_faces) break;
  }
  to_map(fewest_, fewest_base_, grid.geometry, polytope);
  return std::nullopt;
}

std::optional<Vec3> SegmentPolytope::build_within(const VoxelGrid& grid, const Vec3& p,
                                                  const Vec3& q, double reach_voxels,
                                                  const Margins& margins) {
  const VoxelBox local = local_box(grid.occupied, p, q, reach_voxels);
  const Index3 size = local.hi - local.lo;
  const Vec3 extent(size.x, size.y, size.z);
  base_ = Vec3(local.lo.x, local.lo.y, local.lo.z);
  const Segment segment{p - base_, q - base_};
  merger_.collect(grid.occupied, local, boxes_);

  const Ellipsoid first = shrink_around_segment(segment.p, segment.q, boxes_);
  if (auto blocked = inflation_.inflate(first, boxes_, extent, segment, kWantedSlack, margins)) {
    const double t = nearest_parameter(segment, blocked->lower, blocked->upper);
    return Vec3(p + t * (q - p));
  }
  grow(first, extent, segment, kWantedSlack, margins);
  redundancy_.filter(inflation_.planes(), extent, margins, faces_);
  return std::nullopt;
}

void SegmentPolytope::grow(const Ellipsoid& first, const Vec3& extent, const Segment& segment,
                           double slack, const Margins& margins) {
  Ellipsoid ellipsoid = first;
  for (int pass = 0; pass < config_.growth_passes; ++pass) {
    Ellipsoid grown;
    if (!grow_inscribed_ellipsoid(inflation_.planes(), ellipsoid, grown)) return;
    if (regrown_.inflate(grown, boxes_, extent, segment, slack, margins)) return;
    std::swap(inflation_, regrown_);
    ellipsoid = grown;
  }
}

void to_map(const std::vector<Plane>& planes, const Vec3& base, const GridGeometry& geometry,
            Polytope& polytope) {
  const auto n = Eigen::Index(planes.size());
  polytope.A.resize(n, 3);
  polytope.b.resize(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const Plane& plane = planes[std::size_t(i)];
    polytope.A.row(i) = plane.normal;
    polytope.b[i] = geometry.resolution_m * (plane.offset + plane.normal.dot(base)) +
                    plane.normal.dot(geometry.origin_map);
  }
}

}  // namespace goshawk::corridor_builder
