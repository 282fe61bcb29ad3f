#include "goshawk/core/inflation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace goshawk {
namespace {

using Word = BitGrid::Word;

// Half extent along x, in voxels, of the structuring element at offset (dy, dz): the largest
// k <= limit with gap(k)^2 + gap(dy)^2 + gap(dz)^2 < r^2, gap(k) = max(0, |k| - 1), r > 0 in
// voxels; -1 if none.
int half_extent(int dy, int dz, double r, int limit) {
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

// A row of the structuring element.
struct Offset {
  int dy;
  int dz;
  int half_extent;  // [voxels] along x
};

// The structuring element's rows, narrow ones first, clipped to what can matter in the grid.
std::vector<Offset> structuring_element(double r, Index3 size) {
  std::vector<Offset> rows;
  const int reach_y = half_extent(0, 0, r, size.y - 1);
  const int reach_z = half_extent(0, 0, r, size.z - 1);
  for (int dz = -reach_z; dz <= reach_z; ++dz) {
    for (int dy = -reach_y; dy <= reach_y; ++dy) {
      const int k = half_extent(dy, dz, r, size.x);
      if (k >= 0) rows.push_back({dy, dz, k});
    }
  }
  std::stable_sort(rows.begin(), rows.end(),
                   [](const Offset& a, const Offset& b) { return a.half_extent < b.half_extent; });
  return rows;
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
      for (const Offset& offset : element) {
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
