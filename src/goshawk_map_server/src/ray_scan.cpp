#include "ray_scan.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace goshawk::map_server {
namespace {

using Word = RayScan::Word;

// A ray is passed through from time 0 to kEnd. Times are integers: sums of them are exact.
constexpr std::int64_t kEnd = std::int64_t{1} << 60;
constexpr std::int64_t kNever = std::int64_t{1} << 61;  // longest time between two faces
constexpr int kFraction = 32;                           // bits of a place along x
constexpr int kMostHeld = 64;                           // voxels of a surface that a ray grazes

// When a ray crosses the faces across one axis.
struct Crossings {
  int first = 0, last = 0;   // voxels at the ends
  int count = 0, step = 1;   // faces between them, and the direction
  std::int64_t next = kEnd;  // time of the first one
  std::int64_t every = kEnd;

  Crossings(double from, double to)
      : first(int(std::floor(from))), last(int(std::floor(to))), count(std::abs(last - first)) {
    const double way = to - from;
    step = way < 0.0 ? -1 : 1;
    if (count == 0) return;
    const double period = double(kEnd) / std::abs(way);
    const double ahead = way > 0.0 ? double(first) + 1.0 - from : from - double(first);
    every = std::int64_t(std::min(period, double(kNever)));
    // Rounding must neither lose nor add a face: the last one comes before the end, the next after.
    const std::int64_t least = kEnd - count * every;
    next = std::clamp(std::int64_t(std::min(ahead * period, double(kNever))), least,
                      least + every - 1);
  }
};

}  // namespace

struct RayScan::Ray {
  Vec3 from, way;
  Crossings x, y, z;

  Ray(const Vec3& a, const Vec3& b)
      : from(a), way(b - a), x(a.x(), b.x()), y(a.y(), b.y()), z(a.z(), b.z()) {}

  // Where it is along x at the faces across another axis: the first place, and the way between two.
  std::int64_t place(const Crossings& c) const {
    const double at = from.x() + way.x() * (double(c.next) / double(kEnd));
    return std::int64_t(at * double(std::int64_t{1} << kFraction));
  }
  std::int64_t advance(const Crossings& c) const {
    if (c.count < 2) return 0;
    const double by = way.x() * (double(c.every) / double(kEnd));
    return std::int64_t(by * double(std::int64_t{1} << kFraction));
  }
};

void RayScan::begin(Index3 lower, Index3 counts) {
  for_touched([this](std::size_t line) {
    std::fill_n(missed_.begin() + std::ptrdiff_t(line) * kLine, kLine, 0);
    std::fill_n(hit_.begin() + std::ptrdiff_t(line) * kLine, kLine, 0);
    touched_[line] = 0;
  });
  lower_ = lower;
  counts_ = counts;
  size_ = {64 * counts.x, 8 * counts.y, 8 * counts.z};
  plane_ = std::int64_t{size_.y} * size_.z;
  const std::size_t words = std::size_t(plane_) * std::size_t(counts.x);
  if (words <= missed_.size()) return;
  missed_.resize(words);
  hit_.resize(words);
  touched_.resize(words / kLine);
}

// Where rays are marked; apart from the scan, so that a write does not make it be read again.
struct RayScan::Marks {
  Word* missed;
  std::uint8_t* touched;
  std::int64_t plane;

  void put(std::size_t at, Word bits) const {
    missed[at] |= bits;
    touched[at / kLine] = 1;
  }
  // The voxels between x0 and x1, in any order, of a row.
  void put(std::int64_t row, int x0, int x1) const {
    const int low = std::min(x0, x1), high = std::max(x0, x1);
    const Word from_low = ~Word{0} << (low & 63), to_high = ~Word{0} >> (63 - (high & 63));
    auto at = std::size_t(row + (low >> 6) * plane);
    if ((low >> 6) == (high >> 6)) return put(at, from_low & to_high);
    put(at, from_low);
    for (int w = (low >> 6) + 1; w < (high >> 6); ++w) put(at += std::size_t(plane), ~Word{0});
    put(at + std::size_t(plane), to_high);
  }
};

// From row to row up to the voxel `last`, which is not marked.
template <bool kInside>
void RayScan::walk(const Ray& ray, Index3 last, int steps_y, int steps_z) {
  std::int64_t next_y = ray.y.next, next_z = ray.z.next;
  std::int64_t place_y = ray.place(ray.y), place_z = ray.place(ray.z);
  const std::int64_t advance_y = ray.advance(ray.y), advance_z = ray.advance(ray.z);
  const int low = std::min(ray.x.first, ray.x.last), high = std::max(ray.x.first, ray.x.last);
  int x = ray.x.first, y = ray.y.first, z = ray.z.first;
  std::int64_t row = std::int64_t{z} * size_.y + y;
  const std::int64_t step_z = std::int64_t{ray.z.step} * size_.y;
  const Marks marks{missed_.data(), touched_.data(), plane_};
  const auto put = [&](int x0, int x1) {
    if constexpr (kInside) return marks.put(row, x0, x1);
    if (unsigned(y) >= unsigned(size_.y) || unsigned(z) >= unsigned(size_.z)) return;
    const int a = std::max(std::min(x0, x1), 0), b = std::min(std::max(x0, x1), size_.x - 1);
    if (a <= b) marks.put(row, a, b);
  };
  // Masks in place of branches: which face comes next cannot be foretold.
  for (int n = steps_y + steps_z; n > 0; --n) {
    const std::int64_t by_y = -std::int64_t(next_y <= next_z), by_z = ~by_y;
    const std::int64_t place = (place_y & by_y) | (place_z & by_z);
    const int to = std::clamp(int(place >> kFraction), low, high);
    put(x, to);
    x = to;
    next_y += ray.y.every & by_y;
    place_y += advance_y & by_y;
    next_z += ray.z.every & by_z;
    place_z += advance_z & by_z;
    row += (ray.y.step & by_y) | (step_z & by_z);
    if constexpr (!kInside) {
      y += int(ray.y.step & by_y);
      z += int(ray.z.step & by_z);
    }
  }
  if (ray.x.step > 0 ? x < last.x : x > last.x) put(x, last.x - ray.x.step);
}

void RayScan::cast(const Vec3& from, const Vec3& to, bool hits, const BrickMap* held) {
  const Vec3 corner(64.0 * lower_.x, 8.0 * lower_.y, 8.0 * lower_.z);
  const Ray ray(from - corner, to - corner);
  const auto inside = [&](Index3 v) {
    return unsigned(v.x) < unsigned(size_.x) && unsigned(v.y) < unsigned(size_.y) &&
           unsigned(v.z) < unsigned(size_.z);
  };
  const Index3 first{ray.x.first, ray.y.first, ray.z.first};
  const Index3 end{ray.x.last, ray.y.last, ray.z.last};
  const bool ends_inside = inside(end);
  Index3 last = end;
  if (hits && ends_inside) {
    const auto at =
        std::size_t((end.x >> 6) * plane_ + std::int64_t{end.z} * size_.y + end.y);
    hit_[at] |= Word{1} << (end.x & 63);
    touched_[at / kLine] = 1;
    if (held != nullptr) last = first_held(ray, *held);
  }
  const int steps_y = std::abs(last.y - first.y), steps_z = std::abs(last.z - first.z);
  if (ends_inside && inside(first)) return walk<true>(ray, last, steps_y, steps_z);
  walk<false>(ray, last, steps_y, steps_z);
}

// Backwards from the end while the ray grazes the surface that it ends at.
Index3 RayScan::first_held(const Ray& ray, const BrickMap& map) const {
  Index3 voxel{ray.x.last, ray.y.last, ray.z.last};
  const auto before = [](const Crossings& c) {
    return c.count == 0 ? -kNever : c.next + (c.count - 1) * c.every;
  };
  std::int64_t x = before(ray.x), y = before(ray.y), z = before(ray.z);
  const int most = std::min(kMostHeld, ray.x.count + ray.y.count + ray.z.count - 1);
  for (int k = 0; k < most; ++k) {
    Index3 previous = voxel;
    if (x >= y && x >= z) {
      previous.x -= ray.x.step;
      x -= ray.x.every;
    } else if (y >= z) {
      previous.y -= ray.y.step;
      y -= ray.y.every;
    } else {
      previous.z -= ray.z.step;
      z -= ray.z.every;
    }
    if (!grazes(ray, previous, map)) break;
    voxel = previous;
  }
  return voxel;
}

// Is the voxel an obstacle of the surface in which the ray ends: in the same layer, with its free
// side towards the ray, more of it beside the ray, and no free space behind?
bool RayScan::grazes(const Ray& ray, Index3 voxel, const BrickMap& map) const {
  const Index3 at = voxel + Index3{64 * lower_.x, 8 * lower_.y, 8 * lower_.z};
  if (!map.is_raw(at)) return false;
  const std::array<double, 3> way{std::abs(ray.way.x()), std::abs(ray.way.y()),
                                  std::abs(ray.way.z())};
  const std::array<bool, 3> same{voxel.x == ray.x.last, voxel.y == ray.y.last,
                                 voxel.z == ray.z.last};
  const std::array<int, 3> step{ray.x.step, ray.y.step, ray.z.step};
  constexpr std::array<Index3, 3> unit{Index3{1, 0, 0}, Index3{0, 1, 0}, Index3{0, 0, 1}};
  const auto main = std::size_t(std::max_element(way.begin(), way.end()) - way.begin());
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (!same[axis] || axis == main || way[axis] > 0.5 * way[main]) continue;
    const Index3 beside = unit[3 - axis - main];
    const Index3 towards{unit[axis].x * step[axis], unit[axis].y * step[axis],
                         unit[axis].z * step[axis]};
    const bool exposed = !map.is_raw(at - towards);
    const bool backed = map.is_raw(at + towards) || !map.is_known(at + towards);
    const bool wide = map.is_raw(at + beside) || map.is_raw(at - beside);
    if (exposed && backed && wide) return true;
  }
  return false;
}

}  // namespace goshawk::map_server
