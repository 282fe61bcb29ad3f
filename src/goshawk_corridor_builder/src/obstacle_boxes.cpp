#include "obstacle_boxes.hpp"

#include <algorithm>
#include <bit>

namespace goshawk::corridor_builder {
namespace {

constexpr int kBits = BitGrid::kWordBits;

// The word with the bits outside [x0, x1) cleared; `w` is the word's place in its row.
BitGrid::Word masked(const BitGrid::Word* row, int w, int x0, int x1) {
  BitGrid::Word word = row[w];
  if (w * kBits < x0) word &= ~BitGrid::Word{0} << (x0 - w * kBits);
  if ((w + 1) * kBits > x1) word &= ~BitGrid::Word{0} >> ((w + 1) * kBits - x1);
  return word;
}

// Voxels x0 to x1 of a row as one word, the first in its lowest bit. @pre x1 - x0 <= 64
BitGrid::Word gathered(const BitGrid::Word* row, int x0, int x1) {
  const int w = x0 / kBits;
  const int shift = x0 % kBits;
  BitGrid::Word word = row[w] >> shift;
  if (shift != 0 && (w + 1) * kBits < x1) word |= row[w + 1] << (kBits - shift);
  const int count = x1 - x0;
  return count < kBits ? word & ~(~BitGrid::Word{0} << count) : word;
}

bool is_narrow(const VoxelBox& region) {
  return region.hi.x - region.lo.x <= kBits;
}

}  // namespace

void BoxSet::add(const Vec3& lower, const Vec3& upper, double r) {
  for (int a = 0; a < 3; ++a) {
    lo[a].push_back(lower[a]);
    hi[a].push_back(upper[a]);
  }
  radius.push_back(r);
}

void BoxSet::set(std::size_t i, const Vec3& lower, const Vec3& upper) {
  for (int a = 0; a < 3; ++a) {
    lo[a][i] = lower[a];
    hi[a][i] = upper[a];
  }
}

void BoxSet::copy(std::size_t from, std::size_t to) {
  for (int a = 0; a < 3; ++a) {
    lo[a][to] = lo[a][from];
    hi[a][to] = hi[a][from];
  }
  radius[to] = radius[from];
}

void BoxSet::resize(std::size_t n) {
  for (int a = 0; a < 3; ++a) {
    lo[a].resize(n);
    hi[a].resize(n);
  }
  radius.resize(n);
}

void ObstacleMerger::collect(const BitGrid& occupied, const VoxelBox& region, Index3 base,
                             double radius, BoxSet& boxes) {
  base_ = Vec3(base.x, base.y, base.z);
  radius_ = radius;
  open_.clear();
  for (int z = region.lo.z; z < region.hi.z; ++z) {
    if (z > region.lo.z && layer_repeats(occupied, region, z)) continue;
    collect_layer(occupied, region, z);
    join_layers(z, boxes);
  }
  for (const Rectangle& r : open_) emit(r, region.hi.z, boxes);
}

bool ObstacleMerger::layer_repeats(const BitGrid& occupied, const VoxelBox& region, int z) const {
  const int first = region.lo.x / kBits;
  const int last = (region.hi.x - 1) / kBits;
  const bool narrow = is_narrow(region);
  for (int y = region.lo.y; y < region.hi.y; ++y) {
    const BitGrid::Word* above = occupied.row(y, z);
    const BitGrid::Word* below = occupied.row(y, z - 1);
    if (narrow) {
      if (gathered(above, region.lo.x, region.hi.x) != gathered(below, region.lo.x, region.hi.x)) {
        return false;
      }
      continue;
    }
    for (int w = first; w <= last; ++w) {
      if (masked(above, w, region.lo.x, region.hi.x) !=
          masked(below, w, region.lo.x, region.hi.x)) {
        return false;
      }
    }
  }
  return true;
}

void ObstacleMerger::collect_layer(const BitGrid& occupied, const VoxelBox& region, int z) {
  layer_.clear();
  previous_row_.clear();
  const bool narrow = is_narrow(region);
  BitGrid::Word previous = 0;
  for (int y = region.lo.y; y < region.hi.y; ++y) {
    if (!narrow) {
      row_.clear();
      collect_row(occupied.row(y, z), region, y, z);
      std::swap(row_, previous_row_);
      continue;
    }
    const BitGrid::Word word = gathered(occupied.row(y, z), region.lo.x, region.hi.x);
    if (word == previous) {
      for (const Run& run : previous_row_) layer_[run.rectangle].y1 = y + 1;
      continue;
    }
    row_.clear();
    collect_narrow_row(word, region.lo.x, y, z);
    std::swap(row_, previous_row_);
    previous = word;
  }
}

void ObstacleMerger::collect_narrow_row(BitGrid::Word word, int x0, int y, int z) {
  std::size_t before = 0;
  while (word != 0) {
    const int start = std::countr_zero(word);
    const int length = std::countr_one(word >> start);
    add_run(x0 + start, x0 + start + length, y, z, before);
    if (start + length >= kBits) break;
    word &= ~BitGrid::Word{0} << (start + length);
  }
}

void ObstacleMerger::collect_row(const BitGrid::Word* row, const VoxelBox& region, int y, int z) {
  std::size_t before = 0;
  int start = -1;  // of a run that reaches the end of the word before
  const int last = (region.hi.x - 1) / kBits;
  for (int w = region.lo.x / kBits; w <= last; ++w) {
    const BitGrid::Word word = masked(row, w, region.lo.x, region.hi.x);
    int bit = 0;
    while (bit < kBits) {
      const BitGrid::Word rest = word >> bit;
      if (start < 0) {
        if (rest == 0) break;
        bit += std::countr_zero(rest);
        start = w * kBits + bit;
      } else {
        const int ones = std::countr_one(rest);
        bit += ones;
        if (bit >= kBits) break;
        add_run(start, w * kBits + bit, y, z, before);
        start = -1;
      }
    }
  }
  if (start >= 0) add_run(start, region.hi.x, y, z, before);
}

void ObstacleMerger::add_run(int x0, int x1, int y, int z, std::size_t& before) {
  while (before < previous_row_.size() && previous_row_[before].x0 < x0) ++before;
  if (before < previous_row_.size() && previous_row_[before].x0 == x0 &&
      previous_row_[before].x1 == x1) {
    const std::size_t rectangle = previous_row_[before].rectangle;
    layer_[rectangle].y1 = y + 1;
    row_.push_back({x0, x1, rectangle});
  } else {
    row_.push_back({x0, x1, layer_.size()});
    layer_.push_back({x0, x1, y, y + 1, z});
  }
}

// Both lists are in order of (y0, x0), and no two of a list share it.
void ObstacleMerger::join_layers(int z, BoxSet& boxes) {
  auto before = [](const Rectangle& a, const Rectangle& b) {
    return a.y0 != b.y0 ? a.y0 < b.y0 : a.x0 < b.x0;
  };
  std::size_t k = 0;
  for (Rectangle& r : layer_) {
    while (k < open_.size() && before(open_[k], r)) emit(open_[k++], z, boxes);
    if (k < open_.size() && !before(r, open_[k])) {
      if (open_[k].x1 == r.x1 && open_[k].y1 == r.y1) {
        r.z0 = open_[k].z0;
      } else {
        emit(open_[k], z, boxes);
      }
      ++k;
    }
  }
  for (; k < open_.size(); ++k) emit(open_[k], z, boxes);
  std::swap(open_, layer_);
}

void ObstacleMerger::emit(const Rectangle& r, int z1, BoxSet& boxes) const {
  boxes.add(Vec3(r.x0, r.y0, r.z0) - base_, Vec3(r.x1, r.y1, z1) - base_, radius_);
}

}  // namespace goshawk::corridor_builder
