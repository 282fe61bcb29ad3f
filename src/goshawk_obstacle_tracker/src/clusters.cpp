#include "goshawk/obstacle_tracker/clusters.hpp"

#include <algorithm>
#include <cmath>

namespace goshawk::obstacle_tracker {
namespace {

constexpr std::int64_t kMiddle = std::int64_t{1} << 20;  // 21 bits an axis
constexpr int kBits = 21;

std::uint64_t key_of(std::int64_t x, std::int64_t y, std::int64_t z) {
  return (std::uint64_t(z + kMiddle) << (2 * kBits)) | (std::uint64_t(y + kMiddle) << kBits) |
         std::uint64_t(x + kMiddle);
}

}  // namespace

Clusters::Clusters(double cell_m, double vertical_gap_m)
    : cells_per_m_(1.0 / cell_m), reach_z_(1 + int(std::ceil(vertical_gap_m / cell_m))) {}

std::size_t Clusters::root(std::size_t cell) {
  while (parents_[cell] != cell) cell = parents_[cell] = parents_[parents_[cell]];
  return cell;
}

void Clusters::join(std::size_t cell, std::uint64_t key) {
  const auto found = std::ranges::lower_bound(keys_, key);
  if (found == keys_.end() || *found != key) return;
  parents_[root(std::size_t(found - keys_.begin()))] = root(cell);
}

std::span<Cluster> Clusters::group(std::span<const MovingPoint> points) {
  entries_.clear(), keys_.clear(), clusters_.clear();
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Vec3 p = (cells_per_m_ * points[i].p_map).array().floor();
    if (p.cwiseAbs().maxCoeff() >= double(kMiddle - 64)) continue;
    entries_.push_back(
        {key_of(std::int64_t(p.x()), std::int64_t(p.y()), std::int64_t(p.z())), std::uint32_t(i)});
  }
  std::ranges::sort(entries_, [](const Entry& a, const Entry& b) {
    return a.key != b.key ? a.key < b.key : a.point < b.point;
  });
  for (const Entry& e : entries_) {
    if (keys_.empty() || keys_.back() != e.key) keys_.push_back(e.key);
  }
  parents_.resize(keys_.size());
  for (std::size_t c = 0; c < keys_.size(); ++c) parents_[c] = c;
  for (std::size_t c = 0; c < keys_.size(); ++c) {
    for (int z = 0; z <= reach_z_; ++z) {
      for (int y = -1; y <= 1; ++y) {
        for (int x = -1; x <= 1; ++x) {
          const std::int64_t step =
              (std::int64_t(z) << (2 * kBits)) + std::int64_t(y) * (std::int64_t{1} << kBits) + x;
          if (step > 0) join(c, keys_[c] + std::uint64_t(step));
        }
      }
    }
  }
  cluster_of_.assign(keys_.size(), -1);
  std::size_t cell = 0;
  for (const Entry& e : entries_) {
    while (keys_[cell] != e.key) ++cell;
    std::int32_t& number = cluster_of_[root(cell)];
    const MovingPoint& p = points[e.point];
    if (number < 0) {
      number = std::int32_t(clusters_.size());
      clusters_.push_back({.lower_map = p.p_map, .upper_map = p.p_map});
    }
    Cluster& cluster = clusters_[std::size_t(number)];
    cluster.lower_map = cluster.lower_map.cwiseMin(p.p_map);
    cluster.upper_map = cluster.upper_map.cwiseMax(p.p_map);
    cluster.t_s += p.t_s;
    ++cluster.points;
    cluster.standing_free += p.stands_free ? 1 : 0;
  }
  for (Cluster& c : clusters_) c.t_s /= c.points;
  return clusters_;
}

}  // namespace goshawk::obstacle_tracker
