#include "ball_proof.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

namespace goshawk {
namespace {

using RowWord = BitGrid::Word;

constexpr double kWidest_voxels = 8.0;  // a curve that spans more is halved first

Vec3 nearest_in_cube(Index3 voxel, const Vec3& p) {
  const Vec3 low(voxel.x, voxel.y, voxel.z);
  return p.cwiseMax(low).cwiseMin(low + Vec3::Ones());
}

double cube_distance(Index3 voxel, const Vec3& p) {
  return (p - nearest_in_cube(voxel, p)).norm();
}

/// A lower bound of the distance between a cube and a curve's hull: how far the plane through the
/// cube's point that is nearest to the hull's middle keeps them apart.
double hull_distance(Index3 voxel, const BallProof::Points& curve, const Vec3& middle) {
  const Vec3 nearest = nearest_in_cube(voxel, middle);
  const Vec3 away = middle - nearest;
  const double length = away.norm();
  if (!(length > 0.0)) return 0.0;
  return (away.transpose() * (curve.colwise() - nearest)).minCoeff() / length;
}

}  // namespace

BallProof::BallProof(const FreeSpace::View& space, double touch, const std::optional<Vec3>& rest)
    : space_(space),
      touch_(touch),
      radius_(space.grid->inflation_m / space.grid->geometry.resolution_m),
      rest_(rest) {}

double BallProof::least_distance(Index3 voxel) const {
  const double least = rest_ ? std::min(radius_, cube_distance(voxel, *rest_)) : radius_;
  return least - touch_;
}

bool BallProof::is_inside(const Vec3& low, const Vec3& high) const {
  const Index3 size = space_.grid->geometry.size;
  return (low.array() >= -touch_).all() && high.x() <= size.x + touch_ &&
         high.y() <= size.y + touch_ && high.z() <= size.z + touch_;
}

// The blocking cubes that come within the radius of a box, row by row.
// @param visit returns whether to go on @return whether all were visited
template <typename Visit>
bool BallProof::for_cubes_near(const Vec3& low, const Vec3& high, const Visit& visit) const {
  const VoxelGrid& grid = *space_.grid;
  const Index3 size = grid.geometry.size;
  const auto from = [&](int axis, int n) {
    return int(std::clamp(std::floor(low[axis] - radius_), 0.0, double(n - 1)));
  };
  const auto to = [&](int axis, int n) {
    return int(std::clamp(std::floor(high[axis] + radius_), 0.0, double(n - 1)));
  };
  const int x0 = from(0, size.x), x1 = to(0, size.x);
  for (int z = from(2, size.z); z <= to(2, size.z); ++z) {
    for (int y = from(1, size.y); y <= to(1, size.y); ++y) {
      const RowWord* raw = grid.raw.row(y, z);
      const RowWord* known = space_.asks_for_known ? grid.known.row(y, z) : nullptr;
      for (int w = x0 >> 6; w <= x1 >> 6; ++w) {
        RowWord bits = raw[w] | (known != nullptr ? ~known[w] : 0);
        if (w == x0 >> 6) bits &= ~RowWord{0} << (x0 & 63);
        if (w == x1 >> 6) bits &= ~RowWord{0} >> (63 - (x1 & 63));
        for (; bits != 0; bits &= bits - 1) {
          if (!visit(Index3{64 * w + std::countr_zero(bits), y, z})) return false;
        }
      }
    }
  }
  return true;
}

bool BallProof::holds(const Points& curve) const {
  const Vec3 low = curve.rowwise().minCoeff(), high = curve.rowwise().maxCoeff();
  if (!is_inside(low, high) || (high - low).maxCoeff() > kWidest_voxels) return false;
  const Vec3 middle = curve.rowwise().mean();
  return for_cubes_near(low, high, [&](Index3 voxel) {
    return hull_distance(voxel, curve, middle) >= least_distance(voxel);
  });
}

std::optional<Index3> BallProof::too_near(const Vec3& point) const {
  if (!is_inside(point, point)) {
    const Vec3 voxel = point.array().floor().matrix();
    return Index3{int(voxel.x()), int(voxel.y()), int(voxel.z())};
  }
  std::optional<Index3> found;
  for_cubes_near(point, point, [&](Index3 voxel) {
    if (cube_distance(voxel, point) < least_distance(voxel)) found = voxel;
    return !found;
  });
  return found;
}

}  // namespace goshawk
