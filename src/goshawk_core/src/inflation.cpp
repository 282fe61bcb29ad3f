#include "goshawk/core/inflation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "structuring_element.hpp"

namespace goshawk {
namespace {

using Word = BitGrid::Word;

// out |= in shifted by `shift` voxels towards larger x (smaller if negative), whole row.
void or_shifted(Word* out, const Word* in, std::size_t words, int shift) {
  const std::size_t skip = std::size_t(std::abs(shift)) / 64;
  const int bits = std::abs(shift) % 64;
  if (skip >= words) return;
  for (std::size_t i = skip; i < words; ++i) {
    const std::size_t source = i - skip;
    if (shift >= 0) {
      Word word = in[source] << bits;
      if (bits != 0 && source > 0) word |= in[source - 1] >> (64 - bits);
      out[i] |= word;
    } else {
      const std::size_t mirrored = words - 1 - source;
      Word word = in[mirrored] >> bits;
      if (bits != 0 && mirrored + 1 < words) word |= in[mirrored + 1] << (64 - bits);
      out[words - 1 - i] |= word;
    }
  }
}

// Widens a row that is already dilated by `covered` voxels to `k` >= covered, to both sides, by
// doubling: O(log k) shifts instead of 2 k.
void widen_row(std::vector<Word>& row, std::vector<Word>& scratch, int covered, int k) {
  while (covered < k) {
    const int step = std::min(std::max(covered, 1), k - covered);
    scratch = row;
    or_shifted(row.data(), scratch.data(), row.size(), step);
    or_shifted(row.data(), scratch.data(), row.size(), -step);
    covered += step;
  }
}

// Does a radius of r voxels join any two voxels of a grid? Then there is nothing to compute, and
// the structuring element would be larger than the grid.
bool reaches_everywhere(double r, Index3 size) {
  const auto gap = [](int n) { return double(std::max(0, n - 2)); };
  return r > 1.001 * std::hypot(gap(size.x), gap(size.y), gap(size.z));
}

// to |= from, but for the padding.
void or_row(Word* to, const std::vector<Word>& from, Word last_mask) {
  const std::size_t last = from.size() - 1;
  for (std::size_t i = 0; i < last; ++i) to[i] |= from[i];
  to[last] |= from[last] & last_mask;
}

bool any(const Word* row, std::size_t words) {
  for (std::size_t i = 0; i < words; ++i) {
    if (row[i] != 0) return true;
  }
  return false;
}

}  // namespace

Result<BitGrid> inflate(const BitGrid& occupied, double radius_m, double resolution_m) {
  if (!(std::isfinite(radius_m) && radius_m >= 0.0 && std::isfinite(resolution_m) &&
        resolution_m > 0.0)) {
    return fail(ErrorCode::invalid_input,
                fmt::format("cannot inflate obstacles by {:g} m at a resolution of {:g} m: both "
                            "must be finite, the radius at least 0, the resolution above 0",
                            radius_m, resolution_m));
  }
  const Index3 size = occupied.size();
  if (auto status = BitGrid::check_size(size); !status) return status.error();
  if (radius_m == 0.0) return occupied;
  const double r = radius_m / resolution_m;
  if (reaches_everywhere(r, size)) {
    return BitGrid(size, occupied.outside(), occupied.count() > 0);
  }
  const std::size_t words = occupied.words_per_row();
  const auto element = structuring_element(r, size);
  // Only real bits may be a source: padding stands for the outside, which does not grow.
  const Word last_mask = (size.x & 63) == 0 ? ~Word{0} : (Word{1} << (size.x & 63)) - 1;

  BitGrid grown = occupied;
  std::vector<Word> row(words);
  std::vector<Word> scratch(words);
  for (int z = 0; z < size.z; ++z) {
    for (int y = 0; y < size.y; ++y) {
      const Word* source = occupied.row(y, z);
      row.assign(source, source + words);
      row.back() &= last_mask;
      if (!any(row.data(), words)) continue;
      int covered = 0;
      for (const ElementRow& offset : element) {
        const int to_y = y + offset.dy;
        const int to_z = z + offset.dz;
        if (to_y < 0 || to_y >= size.y || to_z < 0 || to_z >= size.z) continue;
        widen_row(row, scratch, covered, offset.half_extent);
        covered = offset.half_extent;
        or_row(grown.mutable_row(to_y, to_z), row, last_mask);
      }
    }
  }
  return grown;
}

}  // namespace goshawk
