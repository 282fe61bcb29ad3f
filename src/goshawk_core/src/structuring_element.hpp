#pragma once

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <vector>

#include "goshawk/core/vector.hpp"

namespace goshawk {

/// A row of the set of voxels that an obstacle grows into.
struct ElementRow {
  int dy;
  int dz;
  int half_extent;  // [voxels] along x
};

/// Half extent along x, in voxels, of the structuring element at offset (dy, dz): the largest
/// k <= limit with gap(k)^2 + gap(dy)^2 + gap(dz)^2 < r^2, gap(k) = max(0, |k| - 1), r > 0 in
/// voxels; -1 if none.
inline int half_extent(int dy, int dz, double r, int limit) {
  const auto gap = [](int k) { return double(std::max(0, std::abs(k) - 1)); };
  const double taken = gap(dy) * gap(dy) + gap(dz) * gap(dz);
  // A radius of n voxels must not reach n + 1 through rounding (0.6 / 0.2 > 3): the strict
  // comparison gets a slack far below a hair and far above an ulp. It is relative, and what
  // touches (taken = 0) is met however small the radius.
  const double rest = r * r * (1.0 - 1e-9) - taken;
  if (taken > 0.0 && rest <= 0.0) return -1;
  const double k = std::max(1.0, std::ceil(std::sqrt(std::max(0.0, rest))));
  return int(std::min(k, double(limit)));
}

/// The rows of the structuring element of radius r voxels, narrow ones first, clipped to what can
/// matter in a grid of this size.
inline std::vector<ElementRow> structuring_element(double r, Index3 size) {
  std::vector<ElementRow> rows;
  const int reach_y = half_extent(0, 0, r, size.y - 1);
  const int reach_z = half_extent(0, 0, r, size.z - 1);
  for (int dz = -reach_z; dz <= reach_z; ++dz) {
    for (int dy = -reach_y; dy <= reach_y; ++dy) {
      const int k = half_extent(dy, dz, r, size.x);
      if (k >= 0) rows.push_back({dy, dz, k});
    }
  }
  std::stable_sort(rows.begin(), rows.end(), [](const ElementRow& a, const ElementRow& b) {
    return a.half_extent < b.half_extent;
  });
  return rows;
}

}  // namespace goshawk
