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

// Rays that wait for each other: more go along with others that have as far to go, until they leave
// the cache.
constexpr std::size_t kWaiting = 512;
constexpr std::size_t kStride = 131;  // a prime

bool holds(Index3 size, Index3 v) {
  return unsigned(v.x) < unsigned(size.x) && unsigned(v.y) < unsigned(size.y) &&
         unsigned(v.z) < unsigned(size.z);
}

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

RayScan::RayScan(Walking walking)
    : walk_rows_(walking == Walking::fastest ? walk_rows_avx2() : nullptr), order_(kWaiting) {
  if (walk_rows_ == nullptr) walk_rows_ = walk_rows;
  for (Waiting& waiting : waiting_) waiting.walks.resize(kWaiting);
}

void RayScan::begin(Index3 lower, Index3 counts) {
  lower_ = lower;
  counts_ = counts;
  size_ = {64 * counts.x, 8 * counts.y, 8 * counts.z};
  rows_.clear(size_);
  columns_.clear({size_.y, size_.x, size_.z});
  hit_.assign(rows_.missed.size(), 0);
  for (Waiting& waiting : waiting_) waiting.count = 0;
}

// A ray that the box does not hold, from row to row: what lies outside is left out.
template <bool kUp>
void RayScan::walk_through(Bits& bits, const Ray& ray, Index3 last) {
  const RowBits rows = bits.rows();
  const Index3 size = bits.size;
  RayWalk walk(ray, last, size.y);
  int y = ray.y.first, z = ray.z.first;
  const auto put = [&](std::int64_t row, std::int64_t low, std::int64_t high) {
    if (unsigned(y) >= unsigned(size.y) || unsigned(z) >= unsigned(size.z)) return;
    low = std::max<std::int64_t>(low, 0);
    high = std::min<std::int64_t>(high, size.x - 1);
    if (low <= high) rows.put(row, low, high);
  };
  const auto left = [](int at, int step, int count) { return step > 0 ? at >= count : at < 0; };
  while (walk.rows_left > 0) {
    const std::int64_t row = walk.row, x = walk.x;
    const bool by_z = walk.step<kUp>() != 0;
    put(row, kUp ? x : walk.x, kUp ? walk.x : x);
    (by_z ? z : y) += by_z ? ray.z.step : ray.y.step;
    if (left(y, ray.y.step, size.y) || left(z, ray.z.step, size.z)) return;
  }
  if (kUp ? walk.x < last.x : walk.x > last.x) {
    put(walk.row, kUp ? walk.x : last.x + 1, kUp ? last.x - 1 : walk.x);
  }
}

// In the order of how far they have to go, by counting.
void RayScan::walk(Bits& bits, Waiting& waiting, bool up) {
  constexpr std::size_t kBins = 512;
  const std::span<RayWalk> walks(waiting.walks.data(), std::exchange(waiting.count, 0));
  const auto bin = [](const RayWalk& w) { return std::min(std::size_t(w.rows_left), kBins - 1); };
  std::array<std::uint16_t, kBins + 1> begin{};
  for (const RayWalk& w : walks) ++begin[bin(w) + 1];
  for (std::size_t k = 1; k <= kBins; ++k) begin[k] = std::uint16_t(begin[k] + begin[k - 1]);
  // Not in the order in which they came: neighbours would wait for each other's words.
  const std::size_t stride = walks.size() % kStride != 0 ? kStride % walks.size() : 1;
  for (std::size_t n = 0, k = 0; n < walks.size(); ++n) {
    order_[begin[bin(walks[k])]++] = std::uint16_t(k);
    k += stride;
    if (k >= walks.size()) k -= walks.size();
  }
  walk_rows_(bits.rows(), walks, {order_.data(), walks.size()}, up);
}

void RayScan::walk_waiting() {
  for (std::size_t k = 0; k < waiting_.size(); ++k) {
    if (waiting_[k].count > 0) walk(k / 2 == 0 ? rows_ : columns_, waiting_[k], k % 2 == 1);
  }
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
  const bool up = ray.x.step > 0;
  if (!ends_inside || !holds(bits.size, ray.first())) {
    return up ? walk_through<true>(bits, ray, last) : walk_through<false>(bits, ray, last);
  }
  Waiting& waiting = waiting_[2 * std::size_t(along_y) + std::size_t(up)];
  waiting.walks[waiting.count] = RayWalk(ray, last, bits.size.y);
  if (++waiting.count == kWaiting) walk(bits, waiting, up);
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
