#include "goshawk/obstacle_tracker/evidence_grid.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace goshawk::obstacle_tracker {
namespace {

constexpr int kFreeAround = 18;  // of 26: beside a flat surface at most 17 cells were seen free
constexpr std::int32_t kRestless_ms = 1000;
constexpr double kShy_cells = 2;  // before a hit, where rays say nothing

int modulo(int i, int n) {
  const int r = i % n;
  return r < 0 ? r + n : r;
}

// Cells along x, y and z.
Index3 size_of(const EvidenceGrid::Parameters& p) {
  const int across = 2 * int(std::ceil(p.range_m / p.cell_m)) + 3;
  return {across, across, int(std::ceil(p.height_m / p.cell_m)) + 1};
}

}  // namespace

double EvidenceGrid::cell_count(const Parameters& p) {
  const Index3 size = size_of(p);
  return double(size.x) * double(size.y) * double(size.z);
}

EvidenceGrid::EvidenceGrid(const Parameters& p)
    : cells_per_m_(1.0 / p.cell_m),
      settle_ms_(std::int32_t(1e3 * p.settle_s)),
      memory_ms_(std::int32_t(1e3 * p.memory_s)),
      range_m_(p.range_m),
      size_(size_of(p)) {
  cells_.resize(std::size_t(size_.x) * std::size_t(size_.y) * std::size_t(size_.z));
}

Index3 EvidenceGrid::cell_of(const Vec3& p) const {
  return {int(std::floor(p.x() * cells_per_m_)), int(std::floor(p.y() * cells_per_m_)),
          int(std::floor(p.z() * cells_per_m_))};
}

bool EvidenceGrid::inside(Index3 i) const {
  const Index3 d = i - lower_;
  return d.x >= 0 && d.y >= 0 && d.z >= 0 && d.x < size_.x && d.y < size_.y && d.z < size_.z;
}

std::size_t EvidenceGrid::address(Index3 i) const {
  const int x = modulo(i.x, size_.x), y = modulo(i.y, size_.y), z = modulo(i.z, size_.z);
  return (std::size_t(z) * std::size_t(size_.y) + std::size_t(y)) * std::size_t(size_.x) +
         std::size_t(x);
}

void EvidenceGrid::begin(const Vec3& center_map, std::int32_t time_ms) {
  now_ms_ = time_ms;
  const Index3 c = cell_of(center_map);
  const Index3 lower{c.x - size_.x / 2, c.y - size_.y / 2, c.z - size_.z / 2};
  if (begun_) {
    clear_entering(lower);
  } else {
    lower_ = lower;
  }
  begun_ = true;
}

// Cells that are in the new window and were not in the old one.
void EvidenceGrid::clear_entering(Index3 lower) {
  if (lower == lower_) return;
  const Index3 old = lower_;
  lower_ = lower;
  for (int z = lower.z; z < lower.z + size_.z; ++z) {
    const bool z_stays = z >= old.z && z < old.z + size_.z;
    for (int y = lower.y; y < lower.y + size_.y; ++y) {
      const bool y_stays = y >= old.y && y < old.y + size_.y;
      int from = lower.x, to = lower.x + size_.x;
      if (z_stays && y_stays) {  // only what enters along x
        if (lower.x >= old.x) from = std::max(lower.x, old.x + size_.x);
        if (lower.x < old.x) to = std::min(to, old.x);
      }
      for (int x = from; x < to; ++x) cells_[address({x, y, z})] = Cell{};
    }
  }
}

void EvidenceGrid::hit(const Vec3& p_map) {
  const Index3 i = cell_of(p_map);
  if (!inside(i)) return;
  Cell& cell = cells_[address(i)];
  if (cell.first_ms == kNever) {
    cell.first_ms = now_ms_;
    cell.restless = cell.ended_ms != kNever && now_ms_ - cell.ended_ms < kRestless_ms;
  }
  cell.hit_ms = now_ms_;
  cell.misses = 0;
}

void EvidenceGrid::mark_free(Cell& cell) {
  if (cell.hit_ms == now_ms_ || cell.passed_ms == now_ms_) return;
  cell.passed_ms = now_ms_;
  if (cell.first_ms != kNever) {
    if (++cell.misses < 2) return;
    cell.first_ms = kNever;
    cell.ended_ms = now_ms_;
  }
  cell.free_ms = now_ms_;
}

// Amanatides and Woo 1987, in cells.
void EvidenceGrid::pass(const Vec3& from_map, const Vec3& to_map) {
  const Vec3 from = cells_per_m_ * from_map, way = cells_per_m_ * (to_map - from_map);
  const double length = way.norm();
  const double last = std::min(length - kShy_cells, range_m_ * cells_per_m_);
  if (!(last > 0.0)) return;
  const Index3 first = cell_of(from_map), edge = lower_ + size_;
  std::array<int, 3> at{first.x, first.y, first.z};
  const std::array<int, 3> lower{lower_.x, lower_.y, lower_.z}, upper{edge.x, edge.y, edge.z};
  const std::array<int, 3> size{size_.x, size_.y, size_.z};
  std::array<int, 3> step{}, place{};  // place: in memory
  std::array<double, 3> next{}, apart{};
  for (std::size_t a = 0; a < 3; ++a) {
    if (at[a] < lower[a] || at[a] >= upper[a]) return;
    const double slope = way[Eigen::Index(a)] / length;
    const bool moves = std::abs(slope) > 1e-12;
    const double part = from[Eigen::Index(a)] - at[a];
    step[a] = slope > 0.0 ? 1 : -1;
    apart[a] = moves ? 1.0 / std::abs(slope) : std::numeric_limits<double>::infinity();
    next[a] = moves ? apart[a] * (slope > 0.0 ? 1.0 - part : part) : apart[a];
    place[a] = modulo(at[a], size[a]);
  }
  for (double done = 0.0; done < last;) {
    mark_free(cells_[(std::size_t(place[2]) * std::size_t(size[1]) + std::size_t(place[1])) *
                         std::size_t(size[0]) +
                     std::size_t(place[0])]);
    const std::size_t xy = next[0] < next[1] ? 0 : 1, a = next[xy] < next[2] ? xy : 2;
    done = next[a];
    next[a] += apart[a];
    at[a] += step[a];
    if (at[a] < lower[a] || at[a] >= upper[a]) return;
    place[a] += step[a];
    if (place[a] == size[a]) place[a] = 0;
    if (place[a] < 0) place[a] = size[a] - 1;
  }
}

bool EvidenceGrid::is_beside_standing(const Vec3& p_map) const {
  const Index3 c = cell_of(p_map);
  for (int z = -1; z <= 1; ++z) {
    for (int y = -1; y <= 1; ++y) {
      for (int x = -1; x <= 1; ++x) {
        const Index3 i = c + Index3{x, y, z};
        if (inside(i) && stands(i)) return true;
      }
    }
  }
  return false;
}

bool EvidenceGrid::is_free_since(const Vec3& p_map, std::int32_t time_ms) const {
  const Index3 i = cell_of(p_map);
  if (!inside(i)) return false;
  const Cell& cell = cells_[address(i)];
  return cell.first_ms == kNever && cell.free_ms >= time_ms;
}

bool EvidenceGrid::is_new(const Vec3& p_map) const {
  const Index3 i = cell_of(p_map);
  return inside(i) && !stands(i) && was_free(cells_[address(i)]);
}

bool EvidenceGrid::stands_free(const Vec3& p_map) const {
  const Index3 c = cell_of(p_map);
  if (!is_new(p_map) || cells_[address(c)].restless) return false;
  int free = 0;
  for (int z = -1; z <= 1; ++z) {
    for (int y = -1; y <= 1; ++y) {
      for (int x = -1; x <= 1; ++x) {
        const Index3 i = c + Index3{x, y, z};
        if ((x != 0 || y != 0 || z != 0) && inside(i)) free += was_free(cells_[address(i)]);
      }
    }
  }
  return free >= kFreeAround;
}

}  // namespace goshawk::obstacle_tracker
