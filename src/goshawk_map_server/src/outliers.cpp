#include "outliers.hpp"

#include <algorithm>
#include <bit>
#include <utility>
#include <vector>

namespace goshawk::map_server {
namespace {

constexpr std::size_t kFewest = 100;  // points from which on "most of them" means something
constexpr double kFewShare = 0.005;   // of all points, to each side of each axis
constexpr double kLeastGap_m = 20.0;  // between a point and all others
constexpr double kMuchLarger = 4.0;   // a box, for the sake of a few points

// Cubic metres; a flat box counts as one voxel thick.
double volume(const Box& box, double resolution_m) {
  return (box.upper_map - box.lower_map).cwiseMax(resolution_m).prod();
}

// What most points span along each axis.
Box usual_box(const Points& points) {
  Box box;
  std::vector<double> values(points.size());
  const auto few = std::size_t(kFewShare * double(points.size()));
  for (int axis = 0; axis < 3; ++axis) {
    for (std::size_t i = 0; i < points.size(); ++i) values[i] = points[i][axis];
    const auto nth = [&](std::size_t n) {
      std::nth_element(values.begin(), values.begin() + std::ptrdiff_t(n), values.end());
      return values[n];
    };
    box.lower_map[axis] = nth(few);
    box.upper_map[axis] = nth(points.size() - 1 - few);
  }
  return box;
}

double distance(const Box& box, const Vec3& p) {
  return (p - p.cwiseMax(box.lower_map).cwiseMin(box.upper_map)).norm();
}

}  // namespace

Box box_of(const Points& points) {
  Box box{points.front(), points.front()};
  for (const Vec3& p : points) {
    box.lower_map = box.lower_map.cwiseMin(p);
    box.upper_map = box.upper_map.cwiseMax(p);
  }
  return box;
}

// Outwards from most points: the first gap that is wider than all before it is long, along
// whatever axis (a floor with a few points above it has no outliers), parts the others from them.
std::optional<Outliers> find_outliers(const Points& points, double resolution_m) {
  if (points.size() < kFewest) return {};
  const Box usual = usual_box(points);
  std::vector<std::pair<double, std::size_t>> others;  // distance [m], number
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (const double d = distance(usual, points[i]); d > 0.0) others.emplace_back(d, i);
  }
  std::ranges::sort(others);
  Outliers found;
  found.rest = usual;
  std::size_t near = 0;
  for (; near < others.size(); ++near) {
    const Vec3& p = points[others[near].second];
    const double length_m = (found.rest.upper_map - found.rest.lower_map).maxCoeff();
    if (distance(found.rest, p) > std::max(kLeastGap_m, length_m)) break;
    found.rest.lower_map = found.rest.lower_map.cwiseMin(p);
    found.rest.upper_map = found.rest.upper_map.cwiseMax(p);
  }
  if (near == others.size()) return {};
  found.count = std::int64_t(others.size() - near);
  found.farthest_map = points[others.back().second];
  const double whole = volume(box_of(points), resolution_m);
  if (whole < kMuchLarger * volume(found.rest, resolution_m)) return {};
  return found;
}

bool is_alone(const BitGrid& occupied, Index3 voxel) {
  for (int z = -1; z <= 1; ++z) {
    for (int y = -1; y <= 1; ++y) {
      for (int x = -1; x <= 1; ++x) {
        const Index3 near = voxel + Index3{x, y, z};
        if (near == voxel || !occupied.contains(near)) continue;
        if (occupied.get(near)) return false;
      }
    }
  }
  return true;
}

std::int64_t drop_lonely(BitGrid& occupied) {
  const BitGrid before = occupied;
  const Index3 n = before.size();
  std::int64_t dropped = 0;
  for (int z = 0; z < n.z; ++z) {
    for (int y = 0; y < n.y; ++y) {
      for (std::size_t w = 0; w < before.words_per_row(); ++w) {
        for (BitGrid::Word bits = before.row(y, z)[w]; bits != 0; bits &= bits - 1) {
          const Index3 voxel{int(w) * BitGrid::kWordBits + std::countr_zero(bits), y, z};
          if (voxel.x >= n.x) break;  // padding
          if (!is_alone(before, voxel)) continue;
          occupied.set(voxel, false);
          ++dropped;
        }
      }
    }
  }
  return dropped;
}

}  // namespace goshawk::map_server
