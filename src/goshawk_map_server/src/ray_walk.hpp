#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "goshawk/core/brick_map.hpp"
#include "ray.hpp"

namespace goshawk::map_server {

/// Rows of bits along a ray's first axis.
struct RowBits {
  using Word = BrickMap::Word;

  Word* words;         // ((first / 64) * size z + z) * size of the second + second
  std::int64_t plane;  // words of all rows with the same 64 of the first axis

  /// Sets the bits low .. high of a row.
  void put(std::int64_t row, std::int64_t low, std::int64_t high) const {
    const Word from = ~Word{0} << (low & 63), to = ~Word{0} >> (~high & 63);
    Word* word = words + (row + (low >> 6) * plane);
    if ((low >> 6) == (high >> 6)) {
      *word |= from & to;
      return;
    }
    *word |= from;
    for (std::int64_t w = (low >> 6) + 1; w < (high >> 6); ++w) *(word += plane) = ~Word{0};
    word[plane] |= to;
  }
};

/// A ray on its way from row to row. Rows lie along its first axis, which is called x here. Times
/// are those of Crossings; places along the rows have 32 bits of fraction.
struct RayWalk {
  static constexpr int kFraction = 32;

  std::int64_t until_z;               // from the next face across y to the next one across z
  std::int64_t every_y, both;         // between two faces across y; added to that across z
  std::int64_t place_y, place_z;      // along the row, at the next face across y, and across z
  std::int64_t advance_y, advance_z;  // of these places from face to face
  std::int64_t row, row_y, row_more;  // of the bits; a step across y; how much more one across z is
  std::int64_t x, last_x;             // where it is, and where it ends
  std::int64_t rows_left;             // faces across y and z until its end

  RayWalk() = default;
  /// @param last the voxel before which it stops @param size_y rows of a layer
  RayWalk(const Ray& ray, Index3 last, std::int64_t size_y);

  /// To the next row. @return by how much z changes: all ones across z, else zero
  template <bool kUp>
  std::int64_t step();
};

/// Sets the bits that rays pass, all of which lie inside of the rows. @param up the sign of their
/// way along the rows @param order of the walks, best by rows_left, so that rays that go along
/// together have equally far to go
using WalkRows = void (*)(const RowBits& bits, std::span<RayWalk> walks,
                          std::span<const std::uint16_t> order, bool up);

/// Ray by ray.
void walk_rows(const RowBits& bits, std::span<RayWalk> walks, std::span<const std::uint16_t> order,
               bool up);
/// Four rays at once; the same bits. @return null if this processor has no AVX2
WalkRows walk_rows_avx2();

// Masks in place of branches: which face comes next cannot be foretold.
template <bool kUp>
std::int64_t RayWalk::step() {
  const std::int64_t by_z = until_z >> 63;
  const std::int64_t place = (place_y ^ ((place_y ^ place_z) & by_z)) >> kFraction;
  x = kUp ? (x > place ? x : place) : (x < place ? x : place);
  until_z += (both & by_z) - every_y;
  place_y += advance_y & ~by_z;
  place_z += advance_z & by_z;
  row += row_y + (row_more & by_z);
  --rows_left;
  return by_z;
}

}  // namespace goshawk::map_server
