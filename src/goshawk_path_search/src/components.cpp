#include "goshawk/path_search/components.hpp"

#include <algorithm>
#include <bit>
#include <cstdlib>

#include "goshawk/core/grid_update.hpp"

namespace goshawk::path_search {
namespace {

constexpr int kBrickSide = BitGrid::kChunkSide;  // along y and z

/// The runs of ones of a word, lowest first.
class Runs {
 public:
  explicit Runs(std::uint64_t word) : left_(word) { next(); }

  bool at_end() const { return begin_ == end_; }
  int begin() const { return begin_; }
  int end() const { return end_; }
  void next() {
    if (left_ == 0) {
      begin_ = end_;
      return;
    }
    // Adding the lowest one carries through its run.
    const std::uint64_t sum = left_ + (left_ & (~left_ + 1));
    begin_ = std::countr_zero(left_);
    end_ = sum == 0 ? 64 : std::countr_zero(sum);
    left_ &= sum;
  }

 private:
  std::uint64_t left_;
  int begin_ = 0;
  int end_ = 0;
};

int runs_in(std::uint64_t word) {
  return std::popcount(word & ~(word << 1));
}

/// Calls touch(i, j) for the i-th run of a and the j-th of b that come within `reach` of each other
/// along x.
template <typename Touch>
void each_touch(std::uint64_t a, std::uint64_t b, int reach, const Touch& touch) {
  if ((a & b) == ~std::uint64_t{0}) return touch(0, 0);
  Runs p(a), q(b);
  for (int i = 0, j = 0; !p.at_end() && !q.at_end();) {
    if (p.begin() < q.end() + reach && q.begin() < p.end() + reach) touch(i, j);
    if (p.end() < q.end()) {
      p.next();
      ++i;
    } else {
      q.next();
      ++j;
    }
  }
}

template <typename Number>
Number find_root(std::vector<Number>& roots, Number k) {
  while (roots[k] != k) k = roots[k] = roots[roots[k]];
  return k;
}

// The lower number becomes the root, so that the result depends on the map alone.
template <typename Number>
void unite(std::vector<Number>& roots, Number a, Number b) {
  a = find_root(roots, a);
  b = find_root(roots, b);
  if (a != b) roots[std::max(a, b)] = std::min(a, b);
}

}  // namespace

Components::Components(CornerRule rule) : reach_(rule == CornerRule::squeeze ? 1 : 0) {
  within_ = row_pairs({});
  for (int z = -1; z <= 0; ++z) {
    for (int y = -1; y <= (z < 0 ? 1 : 0); ++y) {
      for (int x = -1; x <= (z < 0 || y < 0 ? 1 : -1); ++x) {
        const Index3 offset{x, y, z};
        if (reach_ == 0 && std::abs(x) + std::abs(y) + std::abs(z) > 1) continue;
        sides_.push_back({offset, row_pairs(offset)});
      }
    }
  }
}

// The rows of a brick and of its neighbour that touch; of one brick, each pair once.
std::vector<Components::RowPair> Components::row_pairs(Index3 offset) const {
  std::vector<RowPair> pairs;
  const bool same_brick = offset == Index3{};
  for (int own = 0; own < kRows; ++own) {
    for (int dz = -1; dz <= 1; ++dz) {
      for (int dy = -1; dy <= 1; ++dy) {
        const int apart = std::abs(dy) + std::abs(dz) + std::abs(offset.x);
        if (reach_ == 0 && apart > 1) continue;
        if (same_brick && (dz > 0 || (dz == 0 && dy >= 0))) continue;
        const int y = own % kBrickSide + dy - kBrickSide * offset.y;
        const int z = own / kBrickSide + dz - kBrickSide * offset.z;
        if (y < 0 || y >= kBrickSide || z < 0 || z >= kBrickSide) continue;
        pairs.push_back({std::uint8_t(own), std::uint8_t(kBrickSide * z + y)});
      }
    }
  }
  return pairs;
}

bool Components::contains(Index3 brick) const {
  return unsigned(brick.x) < unsigned(count_.x) && unsigned(brick.y) < unsigned(count_.y) &&
         unsigned(brick.z) < unsigned(count_.z);
}

Index3 Components::place(std::size_t brick) const {
  const std::size_t row = brick / std::size_t(count_.x);
  return {int(brick % std::size_t(count_.x)), int(row % std::size_t(count_.y)),
          int(row / std::size_t(count_.y))};
}

// The row of a brick, by its number in it; rows outside the map are not free.
std::uint64_t Components::free_row(Index3 brick, int row) const {
  const int y = kBrickSide * brick.y + row % kBrickSide;
  const int z = kBrickSide * brick.z + row / kBrickSide;
  if (y >= held_.size().y || z >= held_.size().z) return 0;
  return ~held_.row(y, z)[brick.x] & bits_inside(brick, held_.size());
}

bool Components::advance(const BitGrid& blocked, int bricks) {
  if (phase_ == Phase::behind) follow(blocked);
  for (; bricks > 0 && phase_ == Phase::labelling; ++next_) {
    if (next_ == bricks_.size()) {
      phase_ = Phase::linking;
      next_ = 0;
      break;
    }
    if (!bricks_[next_].stale) continue;
    label(place(next_), bricks_[next_]);
    --bricks;
  }
  for (; bricks > 0 && phase_ == Phase::linking; ++next_) {
    if (next_ == bricks_.size()) {
      unite_all();
      phase_ = Phase::ready;
      break;
    }
    if (!bricks_[next_].unlinked) continue;
    link(place(next_), bricks_[next_]);
    --bricks;
  }
  return ready();
}

void Components::follow(const BitGrid& blocked) {
  const Index3 size = blocked.size();
  if (held_.size() == size) {
    for_changed_chunks(held_, blocked, [&](BitGrid::Rows rows) { mark_changes(blocked, rows); });
  } else {
    count_ = brick_counts(size);
    bricks_.clear();
    bricks_.resize(std::size_t(count_.x) * std::size_t(count_.y) * std::size_t(count_.z));
  }
  held_ = blocked;
  phase_ = Phase::labelling;
  next_ = 0;
}

void Components::mark_changes(const BitGrid& blocked, BitGrid::Rows rows) {
  for (int x = 0; x < count_.x; ++x) {
    bool differs = false;
    for (int z = rows.z0; z < rows.z1 && !differs; ++z) {
      for (int y = rows.y0; y < rows.y1 && !differs; ++y) {
        differs = held_.row(y, z)[x] != blocked.row(y, z)[x];
      }
    }
    if (differs) mark({x, rows.y0 / kBrickSide, rows.z0 / kBrickSide});
  }
}

void Components::mark(Index3 brick) {
  bricks_[number(brick)].stale = bricks_[number(brick)].unlinked = true;
  for (const Side& side : sides_) {
    const Index3 later = brick - side.offset;  // whose neighbour on that side this one is
    if (contains(later)) bricks_[number(later)].unlinked = true;
  }
}

// A row that equals the one beside it has its runs: each touches its like, and no other one.
void Components::number_runs(Index3 at, Brick& brick) {
  runs_.clear();
  for (int row = 0; row < kRows; ++row) {
    const std::uint64_t free = rows_[std::size_t(row)] = free_row(at, row);
    const auto is_like = [&](int other) { return rows_[std::size_t(other)] == free; };
    std::uint16_t& first = brick.first_run[std::size_t(row)];
    if (free == 0) {
      first = kNoRun;
    } else if (row % kBrickSide != 0 && is_like(row - 1)) {
      first = brick.first_run[std::size_t(row - 1)];
    } else if (row >= kBrickSide && is_like(row - kBrickSide)) {
      first = brick.first_run[std::size_t(row - kBrickSide)];
    } else {
      first = std::uint16_t(runs_.size());
      for (Runs run(free); !run.at_end(); run.next()) {
        runs_.push_back(std::uint16_t(runs_.size()));
      }
    }
  }
}

void Components::label(Index3 at, Brick& brick) {
  number_runs(at, brick);
  RunPair last{};
  for (const RowPair& rows : within_) {
    const RunPair pair{brick.first_run[rows.own], brick.first_run[rows.other]};
    if (pair.own == pair.other || !pair.is_new(last)) continue;
    last = pair;
    each_touch(rows_[rows.own], rows_[rows.other], reach_, [&](int i, int j) {
      unite(runs_, std::uint16_t(pair.own + i), std::uint16_t(pair.other + j));
    });
  }
  brick.component.resize(runs_.size());
  brick.components = 0;
  for (std::size_t k = 0; k < runs_.size(); ++k) {
    const std::uint16_t root = find_root(runs_, std::uint16_t(k));
    brick.component[k] =
        root == k ? std::uint16_t(brick.components++) : brick.component[std::size_t(root)];
  }
  brick.stale = false;
}

/// The free rows of a brick, each looked up when it is first asked for.
class Components::BrickRows {
 public:
  BrickRows(const Components& components, Index3 brick) : components_(components), brick_(brick) {}

  std::uint64_t operator[](std::uint8_t row) {
    const std::uint64_t bit = std::uint64_t{1} << row;
    if ((known_ & bit) == 0) rows_[row] = components_.free_row(brick_, row);
    known_ |= bit;
    return rows_[row];
  }

 private:
  const Components& components_;
  Index3 brick_;
  std::uint64_t known_ = 0;
  std::array<std::uint64_t, kRows> rows_{};
};

void Components::link(Index3 at, Brick& brick) {
  brick.links.clear();
  BrickRows own_rows(*this, at);
  for (std::size_t s = 0; s < sides_.size(); ++s) {
    const Side& side = sides_[s];
    const Index3 there = at + side.offset;
    if (!contains(there)) continue;
    const Brick& other = bricks_[number(there)];
    BrickRows other_rows(*this, there);
    RunPair last{};
    for (const RowPair& rows : side.rows) {
      const RunPair pair{brick.first_run[rows.own], other.first_run[rows.other]};
      if (!pair.is_new(last)) continue;
      last = pair;
      const std::uint64_t a = own_rows[rows.own], b = other_rows[rows.other];
      const auto touch = [&](int i, int j) {
        const Link link{brick.component[std::size_t(pair.own + i)],
                        other.component[std::size_t(pair.other + j)], std::uint8_t(s)};
        if (brick.links.empty() || !(brick.links.back() == link)) brick.links.push_back(link);
      };
      if (side.offset.x == 0) {
        each_touch(a, b, reach_, touch);
      } else if (side.offset.x < 0) {
        if ((a & b >> 63) != 0) touch(0, runs_in(b) - 1);
      } else if ((b & a >> 63) != 0) {
        touch(runs_in(a) - 1, 0);
      }
    }
  }
  brick.unlinked = false;
}

void Components::unite_all() {
  std::uint32_t count = 0;
  for (Brick& brick : bricks_) {
    brick.base = count;
    count += brick.components;
  }
  roots_.resize(count);
  for (std::uint32_t k = 0; k < count; ++k) roots_[k] = k;
  for (std::size_t k = 0; k < bricks_.size(); ++k) {
    const Index3 at = place(k);
    for (const Link& link : bricks_[k].links) {
      const Brick& other = bricks_[number(at + sides_[link.side].offset)];
      unite(roots_, bricks_[k].base + link.own, other.base + link.other);
    }
  }
  for (std::uint32_t k = 0; k < count; ++k) roots_[k] = roots_[roots_[k]];
}

std::uint32_t Components::root_of(Index3 voxel) const {
  const Index3 at{voxel.x / 64, voxel.y / kBrickSide, voxel.z / kBrickSide};
  const Brick& brick = bricks_[number(at)];
  const int row = voxel.z % kBrickSide * kBrickSide + voxel.y % kBrickSide;
  std::size_t run = brick.first_run[std::size_t(row)];
  const std::uint64_t free = ~held_.row(voxel.y, voxel.z)[at.x];
  for (Runs runs(free); runs.end() <= voxel.x % 64; runs.next()) ++run;
  return roots_[brick.base + brick.component[run]];
}

}  // namespace goshawk::path_search
