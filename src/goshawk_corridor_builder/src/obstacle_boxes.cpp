#include "obstacle_boxes.hpp"

#include <algorithm>
#include <bit>

namespace goshawk::corridor_builder {
namespace {

using Word = BitGrid::Word;
constexpr int kWordBits = BitGrid::kWordBits;

// Voxels x0 to x1 of a row as one word, the first in its lowest bit. @pre x1 - x0 <= 64
Word gathered(const Word* row, int x0, int x1) {
  const int w = x0 / kWordBits;
  const int shift = x0 % kWordBits;
  Word word = row[w] >> shift;
  if (shift != 0 && (w + 1) * kWordBits < x1) word |= row[w + 1] << (kWordBits - shift);
  const int count = x1 - x0;
  return count < kWordBits ? word & ~(~Word{0} << count) : word;
}

// visit(row of the slab, its voxels as one word) for each row of a layer.
template <typename Visit>
void for_gathered(const BitGrid& bits, const VoxelBox& slab, int z, const Visit& visit) {
  const std::size_t stride = bits.words_per_row();
  for (int y = slab.lo.y; y < slab.hi.y;) {
    const Word* row = bits.row(y, z);
    // The rows of a chunk lie one behind the other.
    const int end = std::min(slab.hi.y, (y | (BitGrid::kChunkSide - 1)) + 1);
    for (; y < end; ++y, row += stride) {
      visit(std::size_t(y - slab.lo.y), gathered(row, slab.lo.x, slab.hi.x));
    }
  }
}

void gather_layer(const ObstacleVoxels& voxels, const VoxelBox& slab, int z, Word* layer) {
  if (voxels.set != nullptr) {
    for_gathered(*voxels.set, slab, z, [&](std::size_t y, Word word) { layer[y] = word; });
  } else {
    std::fill_n(layer, slab.hi.y - slab.lo.y, Word{0});
  }
  if (voxels.known == nullptr) return;
  const Word used = ~Word{0} >> (kWordBits - (slab.hi.x - slab.lo.x));
  for_gathered(*voxels.known, slab, z,
               [&](std::size_t y, Word word) { layer[y] |= ~word & used; });
}

struct Run {
  int begin, end;
  Word mask;
};

// The longest run of ones that holds a bit. @pre the bit is set
Run run_around(Word word, int bit) {
  const Word zeros_below = ~word & ((Word{1} << bit) - 1);
  const int begin = kWordBits - std::countl_zero(zeros_below);
  const int length = std::countr_one(word >> begin);
  const Word ones = length < kWordBits ? (Word{1} << length) - 1 : ~Word{0};
  return {begin, begin + length, ones << begin};
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

void ObstacleMerger::collect(const ObstacleVoxels& voxels, const VoxelBox& region, Index3 base,
                             double radius, BoxSet& boxes) {
  VoxelBox slab = region;
  for (; slab.lo.x < region.hi.x; slab.lo.x = slab.hi.x) {
    slab.hi.x = std::min(slab.lo.x + kWordBits, region.hi.x);
    gather(voxels, slab);
    const Index3 offset = slab.lo - base;
    merge(Vec3(offset.x, offset.y, offset.z), radius, boxes);
  }
}

// A layer that equals the one below is left out.
void ObstacleMerger::gather(const ObstacleVoxels& voxels, const VoxelBox& slab) {
  rows_ = slab.hi.y - slab.lo.y;
  const auto n = std::size_t(rows_);
  words_.resize(n * std::size_t(slab.hi.z - slab.lo.z));
  heights_.clear();
  Word* layer = words_.data();
  for (int z = slab.lo.z; z < slab.hi.z; ++z) {
    gather_layer(voxels, slab, z, layer);
    if (!heights_.empty() && std::equal(layer, layer + n, layer - n)) continue;
    heights_.push_back(z - slab.lo.z);
    layer += n;
  }
  layers_ = int(heights_.size());
  heights_.push_back(slab.hi.z - slab.lo.z);
  rest_.assign(words_.data(), layer);
}

void ObstacleMerger::merge(const Vec3& offset, double radius, BoxSet& boxes) {
  for (int z = 0; z < layers_; ++z) {
    for (int y = 0; y < rows_; ++y) {
      while (const Word rest = rest_[at(y, z)]) {
        const Run run = run_around(words_[at(y, z)], std::countr_zero(rest));
        int y0 = y, y1 = y + 1, z0 = z, z1 = z + 1;
        while (y0 > 0 && layer_holds(run.mask, y0 - 1, y0, z)) --y0;
        while (y1 < rows_ && layer_holds(run.mask, y1, y1 + 1, z)) ++y1;
        while (z0 > 0 && layer_holds(run.mask, y0, y1, z0 - 1)) --z0;
        while (z1 < layers_ && layer_holds(run.mask, y0, y1, z1)) ++z1;
        clear(run.mask, y0, y1, z, z1);
        boxes.add(offset + Vec3(run.begin, y0, heights_[std::size_t(z0)]),
                  offset + Vec3(run.end, y1, heights_[std::size_t(z1)]), radius);
      }
    }
  }
}

bool ObstacleMerger::layer_holds(Word mask, int y0, int y1, int z) const {
  const Word* words = words_.data() + at(0, z);
  Word all = mask;
  for (int y = y0; y < y1; ++y) all &= words[y];  // to the end: faster than to ask each time
  return all == mask;
}

// Layers below z0 are done already.
void ObstacleMerger::clear(Word mask, int y0, int y1, int z0, int z1) {
  for (int z = z0; z < z1; ++z) {
    Word* words = rest_.data() + at(0, z);
    for (int y = y0; y < y1; ++y) words[y] &= ~mask;
  }
}

}  // namespace goshawk::corridor_builder
