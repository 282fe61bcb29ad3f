#include "ray_scan.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <utility>

#include "grazing.hpp"

namespace goshawk::map_server {
namespace {

using Word = RayScan::Word;

constexpr int kFraction = 32;  // bits of a place along the rows

bool holds(Index3 size, Index3 v) {
  return unsigned(v.x) < unsigned(size.x) && unsigned(v.y) < unsigned(size.y) &&
         unsigned(v.z) < unsigned(size.z);
}

// Where a ray is along its rows at the faces across another axis: the first place, and the way
// between two of them. No place lies beyond the ray's ends.
struct Places {
  std::int64_t next, advance;

  Places(const Ray& ray, const Crossings& c)
      : next(at(ray, ray.from.x(), c.next)), advance(c.count < 2 ? 0 : at(ray, 0.0, c.every)) {
    const std::int64_t low = std::int64_t{std::min(ray.x.first, ray.x.last)} << kFraction;
    const std::int64_t high =
        ((std::int64_t{std::max(ray.x.first, ray.x.last)} + 1) << kFraction) - 1;
    next = std::clamp(next, low, high);
    if (c.count < 2) return;
    const std::int64_t last = next + (c.count - 1) * advance;
    if (last < low || last > high) advance = (std::clamp(last, low, high) - next) / (c.count - 1);
  }

 private:
  static std::int64_t at(const Ray& ray, double from, std::int64_t time) {
    const double voxels = from + ray.way.x() * (double(time) / double(Crossings::kEnd));
    return std::int64_t(voxels * double(std::int64_t{1} << kFraction));
  }
};

// The voxels of a word from one on, and up to one.
struct Masks {
  std::array<Word, 64> from{}, to{};

  constexpr Masks() {
    for (unsigned k = 0; k < 64; ++k) {
      from[k] = ~Word{0} << k;
      to[k] = ~Word{0} >> (63 - k);
    }
  }
};
constexpr Masks kMasks;

// Bit k of word i becomes bit i of word k.
void transpose(std::span<Word, 64> words) {
  Word low = 0xFFFFFFFFU;
  for (std::size_t side = 32; side != 0; side /= 2, low ^= low << side) {
    for (std::size_t k = 0; k < 64; k = ((k | side) + 1) & ~side) {
      const Word swap = ((words[k] >> side) ^ words[k | side]) & low;
      words[k] ^= swap << side;
      words[k | side] ^= swap;
    }
  }
}

}  // namespace

void RayScan::Bits::clear(Index3 voxels) {
  size = voxels;
  plane = std::int64_t{size.y} * size.z;
  missed.assign(std::size_t(plane) * std::size_t((size.x + 63) / 64), 0);
}

void RayScan::begin(Index3 lower, Index3 counts) {
  lower_ = lower;
  counts_ = counts;
  size_ = {64 * counts.x, 8 * counts.y, 8 * counts.z};
  rows_.clear(size_);
  columns_.clear({size_.y, size_.x, size_.z});
  hit_.assign(rows_.missed.size(), 0);
}

// Where rays are marked; apart from the scan, so that a write does not make it be read again.
struct RayScan::Marks {
  Word* missed;
  std::int64_t plane;

  // The voxels low .. high of a row.
  void put(std::int64_t row, int low, int high) const {
    const Word from = kMasks.from[unsigned(low) % 64], to = kMasks.to[unsigned(high) % 64];
    Word* word = missed + (row + (low >> 6) * plane);
    if ((low >> 6) == (high >> 6)) {
      *word |= from & to;
      return;
    }
    *word |= from;
    for (int w = (low >> 6) + 1; w < (high >> 6); ++w) *(word += plane) = ~Word{0};
    word[plane] |= to;
  }
};

// From row to row up to the voxel `last`, which is not marked. Masks in place of branches: which
// face comes next cannot be foretold.
template <bool kInside, bool kUp>
void RayScan::walk(Bits& bits, const Ray& ray, Index3 last) {
  const Index3 size = bits.size;
  const Marks marks{bits.missed.data(), bits.plane};
  const Places at_y(ray, ray.y), at_z(ray, ray.z);
  std::int64_t place_y = at_y.next, place_z = at_z.next;
  const std::int64_t advance_y = at_y.advance, advance_z = at_z.advance;
  std::int64_t until_z = ray.z.next - ray.y.next;  // from the next face across y
  const std::int64_t every_y = ray.y.every, both = ray.y.every + ray.z.every;
  int x = ray.x.first, y = ray.y.first, z = ray.z.first;
  const int step_y = ray.y.step, step_z = ray.z.step;
  std::int64_t row = std::int64_t{z} * size.y + y;
  const std::int64_t row_y = step_y, row_more = std::int64_t{step_z} * size.y - step_y;
  const auto put = [&](int low, int high) {
    if constexpr (kInside) return marks.put(row, low, high);
    if (unsigned(y) >= unsigned(size.y) || unsigned(z) >= unsigned(size.z)) return;
    low = std::max(low, 0);
    high = std::min(high, size.x - 1);
    if (low <= high) marks.put(row, low, high);
  };
  for (int n = std::abs(last.y - y) + std::abs(last.z - z); n > 0; --n) {
    const std::int64_t by_z = until_z >> 63;
    const auto place = int((place_y ^ ((place_y ^ place_z) & by_z)) >> kFraction);
    const int to = kUp ? std::max(x, place) : std::min(x, place);
    put(kUp ? x : to, kUp ? to : x);
    x = to;
    until_z += (both & by_z) - every_y;
    place_y += advance_y & ~by_z;
    place_z += advance_z & by_z;
    row += row_y + (row_more & by_z);
    if constexpr (!kInside) {
      y += step_y & ~int(by_z);
      z += step_z & int(by_z);
    }
  }
  if (kUp ? x < last.x : x > last.x) put(kUp ? x : last.x + 1, kUp ? last.x - 1 : x);
}

void RayScan::cast(const Vec3& from, const Vec3& to, bool hits, const BrickMap* held) {
  const Vec3 corner(64.0 * lower_.x, 8.0 * lower_.y, 8.0 * lower_.z);
  Vec3 a = from - corner, b = to - corner;
  const bool along_y = std::abs(b.y() - a.y()) > std::abs(b.x() - a.x());
  if (along_y) {
    std::swap(a.x(), a.y());
    std::swap(b.x(), b.y());
  }
  const Ray ray(a, b);
  Bits& bits = along_y ? columns_ : rows_;
  Index3 last = ray.last();
  const bool ends_inside = holds(bits.size, last);
  if (hits && ends_inside) {
    const int x = along_y ? last.y : last.x, y = along_y ? last.x : last.y;
    hit_[std::size_t((x >> 6) * rows_.plane + std::int64_t{last.z} * size_.y + y)] |= Word{1}
                                                                                      << (x & 63);
    if (held != nullptr) {
      last = Grazing(*held, {64 * lower_.x, 8 * lower_.y, 8 * lower_.z}, along_y).first_held(ray);
    }
  }
  if (ends_inside && holds(bits.size, ray.first())) {
    return ray.x.step > 0 ? walk<true, true>(bits, ray, last) : walk<true, false>(bits, ray, last);
  }
  return ray.x.step > 0 ? walk<false, true>(bits, ray, last) : walk<false, false>(bits, ray, last);
}

void RayScan::add_columns() {
  std::array<Word, 64> tile;
  for (int w = 0; w < counts_.x; ++w) {
    for (int z = 0; z < size_.z; ++z) {
      for (int v = 0; 64 * v < size_.y; ++v) {
        Word* from =
            columns_.missed.data() + v * columns_.plane + std::int64_t{z} * size_.x + 64 * w;
        Word any = 0;
        for (int k = 0; k < 64; ++k) any |= from[k];
        if (any == 0) continue;
        std::copy_n(from, 64, tile.data());
        std::fill_n(from, 64, 0);
        transpose(tile);
        const int last = std::min(64, size_.y - 64 * v);
        Word* to = rows_.missed.data() + w * rows_.plane + std::int64_t{z} * size_.y + 64 * v;
        for (int k = 0; k < last; ++k) to[k] |= tile[std::size_t(k)];
      }
    }
  }
}

}  // namespace goshawk::map_server
