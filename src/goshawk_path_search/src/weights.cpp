#include "goshawk/path_search/weights.hpp"

#include <algorithm>

namespace goshawk::path_search {
namespace {

constexpr std::uint8_t kCostly = 128;

}  // namespace

CostField::CostField(const Weights& weights) : weights_(weights) {
  const int reach = weights.near_obstacles() ? weights.reach_voxels : 0;
  for (int k = 0; k < kCostly; ++k) {
    const double nearness = k >= 1 && k <= reach ? 1.0 - double(k - 1) / double(reach) : 0.0;
    table_[std::size_t(k)] = 1.0 + weights.clearance * nearness;
    table_[std::size_t(k + kCostly)] = table_[std::size_t(k)] + weights.unknown;
  }
}

void CostField::assign(const BitGrid& blocked, const BitGrid* costly) {
  size_ = blocked.size();
  classes_.assign(std::size_t(blocked.voxels()), 0);
  if (weights_.near_obstacles()) measure_distances(blocked);
  if (costly == nullptr || weights_.unknown == 0.0) return;
  for (int z = 0; z < size_.z; ++z) {
    for (int y = 0; y < size_.y; ++y) {
      for (int x = 0; x < size_.x; ++x) {
        if (costly->get({x, y, z})) classes_[flat({x, y, z})] |= kCostly;
      }
    }
  }
}

// The chessboard distance, up to reach + 1, in two passes over half of the neighbours each
// (Rosenfeld and Pfaltz 1968).
void CostField::measure_distances(const BitGrid& blocked) {
  const auto far = std::uint8_t(weights_.reach_voxels + 1);
  const auto visit = [&](Index3 at, int sign) {
    if (blocked.get(at)) {
      classes_[flat(at)] = 0;
    } else {
      if (sign < 0) classes_[flat(at)] = far;
      lower(at, sign);
    }
  };
  for (int z = 0; z < size_.z; ++z) {
    for (int y = 0; y < size_.y; ++y) {
      for (int x = 0; x < size_.x; ++x) visit({x, y, z}, -1);
    }
  }
  for (int z = size_.z; z-- > 0;) {
    for (int y = size_.y; y-- > 0;) {
      for (int x = size_.x; x-- > 0;) visit({x, y, z}, 1);
    }
  }
}

// To one more than the nearest of the neighbours that come before (sign -1) or after in memory.
void CostField::lower(Index3 at, int sign) {
  std::uint8_t& held = classes_[flat(at)];
  const auto look = [&](int dx, int dy, int dz) {
    const Index3 n{at.x + dx, at.y + dy, at.z + dz};
    const bool inside = unsigned(n.x) < unsigned(size_.x) && unsigned(n.y) < unsigned(size_.y) &&
                        unsigned(n.z) < unsigned(size_.z);
    held = std::min(held, std::uint8_t(inside ? classes_[flat(n)] + 1 : 1));
  };
  for (int a = -1; a <= 1; ++a) {
    for (int b = -1; b <= 1; ++b) look(a, b, sign);
    look(a, sign, 0);
  }
  look(sign, 0, 0);
}

}  // namespace goshawk::path_search
