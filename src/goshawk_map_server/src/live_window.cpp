#include "live_window.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "goshawk/map_server/sensor_watch.hpp"

namespace goshawk::map_server {
namespace {

constexpr double kShortest_voxels = 1e-6;  // a ray up to this ends at the sensor
constexpr double kAhead_bricks = 0.75;     // how far the vehicle gets from the middle of the window

constexpr Index3 kBrickSize{Brick::kSizeX, Brick::kSizeY, Brick::kSizeZ};

Index3 voxel_of(const Vec3& p) {
  return {int(std::floor(p.x())), int(std::floor(p.y())), int(std::floor(p.z()))};
}

int floor_div(int a, int b) {
  return a >= 0 ? a / b : -((b - 1 - a) / b);
}

Index3 whole_bricks(Index3 size) {
  const Index3 n = brick_counts(size);
  return {n.x * kBrickSize.x, n.y * kBrickSize.y, n.z * kBrickSize.z};
}

// A brick's part of a map whose corner is the voxel `at` of the raster that bricks are counted on.
BrickMap::Bits bits_of(const RawVoxels& raw, Index3 at, Index3 brick) {
  BrickMap::Bits bits;
  const Index3 n = raw.geometry.size;
  for (int row = 0; row < Brick::kWords; ++row) {
    const int y = kBrickSize.y * brick.y + row % 8 - at.y;
    const int z = kBrickSize.z * brick.z + row / 8 - at.z;
    if (y < 0 || y >= n.y || z < 0 || z >= n.z) continue;
    const std::int64_t x = std::int64_t{kBrickSize.x} * brick.x - at.x;
    const auto known = raw.known.bits_from(x, y, z);
    bits.known[std::size_t(row)] = known;
    bits.raw[std::size_t(row)] = raw.occupied.bits_from(x, y, z) & known;
  }
  return bits;
}

}  // namespace

Result<LiveWindow> LiveWindow::make(const GridGeometry& geometry, const Growth& growth,
                                    const LiveOptions& options) {
  const Index3 size = options.follows ? whole_bricks(geometry.size) : geometry.size;
  auto map = BrickMap::make(
      size, {growth.inflation_m + growth.reserve_m, geometry.resolution_m,
             growth.unknown != UnknownPolicy::free, growth.unknown == UnknownPolicy::occupied});
  if (!map) return map.error();
  return LiveWindow(*std::move(map), geometry, options);
}

LiveWindow::LiveWindow(BrickMap map, const GridGeometry& geometry, const LiveOptions& options)
    : map_(std::move(map)),
      options_(options),
      resolution_m_(geometry.resolution_m),
      odds_(options.odds),
      archive_(options.max_kept_bytes) {
  const Vec3 steps = (geometry.origin_map / resolution_m_).array().round().matrix();
  lower_voxel_ = {int(steps.x()), int(steps.y()), int(steps.z())};
  odds_.resize(map_.counts());
}

Vec3 LiveWindow::lower_voxel() const {
  return {lower_voxel_.x + double(kBrickSize.x) * moved_.x,
          lower_voxel_.y + double(kBrickSize.y) * moved_.y,
          lower_voxel_.z + double(kBrickSize.z) * moved_.z};
}

GridGeometry LiveWindow::geometry() const {
  return {resolution_m_ * lower_voxel(), resolution_m_, map_.size()};
}

Vec3 LiveWindow::to_voxels(const Vec3& p_map) const {
  return p_map / resolution_m_ - lower_voxel();
}

std::size_t LiveWindow::flat(Index3 b) const {
  const Index3 n = map_.counts();
  return (std::size_t(b.z) * std::size_t(n.y) + std::size_t(b.y)) * std::size_t(n.x) +
         std::size_t(b.x);
}

void LiveWindow::fill(const RawVoxels& raw) {
  const Vec3 origin = to_voxels(raw.geometry.origin_map);
  const Index3 at{int(std::lround(origin.x())), int(std::lround(origin.y())),
                  int(std::lround(origin.z()))};
  const Index3 n = raw.geometry.size;
  const auto bricks = [](int lower, int size, int side, int& first, int& last) {
    first = floor_div(lower, side);
    last = floor_div(lower + size - 1, side);
  };
  Index3 first, last;
  bricks(at.x, n.x, kBrickSize.x, first.x, last.x);
  bricks(at.y, n.y, kBrickSize.y, first.y, last.y);
  bricks(at.z, n.z, kBrickSize.z, first.z, last.z);
  for (int z = first.z; z <= last.z; ++z) {
    for (int y = first.y; y <= last.y; ++y) {
      for (int x = first.x; x <= last.x; ++x) fill_brick({x, y, z}, bits_of(raw, at, {x, y, z}));
    }
  }
}

// Known bits win over what was there before.
void LiveWindow::fill_brick(Index3 brick, const BrickMap::Bits& bits) {
  if (std::ranges::none_of(bits.known, [](auto word) { return word != 0; })) return;
  const Index3 counts = map_.counts();
  const bool inside = unsigned(brick.x) < unsigned(counts.x) &&
                      unsigned(brick.y) < unsigned(counts.y) &&
                      unsigned(brick.z) < unsigned(counts.z);
  if (!inside && !options_.follows) return;
  BrickArchive::Kept now;
  if (!inside) {
    now = archive_.take(brick + moved_).value_or(now);
  } else if (const BrickMap::Bits* held = map_.find(brick)) {
    now = {held->raw, held->known};
  }
  for (std::size_t row = 0; row < Brick::kWords; ++row) {
    now.raw[row] = (now.raw[row] & ~bits.known[row]) | bits.raw[row];
    now.known[row] |= bits.known[row];
  }
  if (!inside) return archive_.keep(brick + moved_, {now.raw, now.known, {}});
  const std::int32_t slot = odds_.find(flat(brick));
  for (int row = 0; row < Brick::kWords; ++row) {
    const auto k = std::size_t(row);
    map_.write(brick, row, now.raw[k], now.known[k]);
    if (slot >= 0) odds_.settle(slot, row, bits.known[k] & ~bits.raw[k], bits.raw[k]);
  }
}

// The first voxel of a brick, on the raster. @param brick counted from the corner of the first
// window
Index3 LiveWindow::corner_of(Index3 brick) const {
  return lower_voxel_ +
         Index3{kBrickSize.x * brick.x, kBrickSize.y * brick.y, kBrickSize.z * brick.z};
}

std::vector<JournalBrick> LiveWindow::bricks_outside() const {
  std::vector<JournalBrick> bricks;
  archive_.for_each([&](Index3 brick, const BrickArchive::Kept& kept) {
    bricks.push_back({corner_of(brick), kept.raw, kept.known});
  });
  return bricks;
}

Result<RawVoxels> LiveWindow::world(std::int64_t max_voxels) const {
  Index3 lower = moved_, upper = moved_ + map_.counts();
  archive_.for_each([&](Index3 b, const BrickArchive::Kept&) {
    lower = {std::min(lower.x, b.x), std::min(lower.y, b.y), std::min(lower.z, b.z)};
    upper = {std::max(upper.x, b.x + 1), std::max(upper.y, b.y + 1), std::max(upper.z, b.z + 1)};
  });
  const Index3 counts = upper - lower;
  const double voxels = double(Brick::kSizeX * Brick::kWords) * counts.x * counts.y * counts.z;
  if (voxels > double(max_voxels)) {
    return fail(ErrorCode::map_too_large,
                fmt::format("the box around all that the map has met has {:.3g} voxels, more than "
                            "max_voxels ({}): raise it",
                            voxels, max_voxels));
  }
  const Index3 corner = corner_of(lower);
  const GridGeometry geometry{
      resolution_m_ * Vec3(corner.x, corner.y, corner.z),
      resolution_m_,
      {kBrickSize.x * counts.x, kBrickSize.y * counts.y, kBrickSize.z * counts.z}};
  RawVoxels all{geometry, BitGrid(geometry.size, true), BitGrid(geometry.size, false)};
  // A brick's rows are whole words of the grid.
  const auto put = [&](Index3 brick, const Brick::Words& raw, const Brick::Words& known) {
    const Index3 to = brick - lower;
    for (int row = 0; row < Brick::kWords; ++row) {
      const auto k = std::size_t(row);
      if (known[k] == 0) continue;
      const int y = kBrickSize.y * to.y + row % 8, z = kBrickSize.z * to.z + row / 8;
      all.known.mutable_row(y, z)[to.x] = known[k];
      all.occupied.mutable_row(y, z)[to.x] = raw[k];
    }
  };
  archive_.for_each(
      [&](Index3 b, const BrickArchive::Kept& kept) { put(b, kept.raw, kept.known); });
  const Index3 n = map_.counts();
  for (int z = 0; z < n.z; ++z) {
    for (int y = 0; y < n.y; ++y) {
      for (int x = 0; x < n.x; ++x) {
        const BrickMap::Bits* held = map_.find({x, y, z});
        if (held != nullptr) put(Index3{x, y, z} + moved_, held->raw, held->known);
      }
    }
  }
  return all;
}

Index3 LiveWindow::follow(const Vec3& p_map) {
  const Vec3 p = to_voxels(p_map);
  const Index3 n = map_.counts();
  const auto move = [](double voxels, int side, int count) {
    const double ahead = voxels / side - 0.5 * count;
    return std::abs(ahead) > kAhead_bricks ? int(std::lround(ahead)) : 0;
  };
  const Index3 by{move(p.x(), kBrickSize.x, n.x), move(p.y(), kBrickSize.y, n.y),
                  move(p.z(), kBrickSize.z, n.z)};
  if (by == Index3{}) return by;
  map_.shift(by, [this](Index3 brick, const BrickMap::Bits& bits) {
    const bool any = std::ranges::any_of(bits.known, [](auto word) { return word != 0; });
    if (any) archive_.keep(brick + moved_, bits);
  });
  std::vector<std::int64_t> from;
  from.reserve(std::size_t(n.x) * std::size_t(n.y) * std::size_t(n.z));
  const auto inside = [&](Index3 b) {
    return unsigned(b.x) < unsigned(n.x) && unsigned(b.y) < unsigned(n.y) &&
           unsigned(b.z) < unsigned(n.z);
  };
  for (int z = 0; z < n.z; ++z) {
    for (int y = 0; y < n.y; ++y) {
      for (int x = 0; x < n.x; ++x) {
        const Index3 before = Index3{x, y, z} + by;
        from.push_back(inside(before) ? std::int64_t(flat(before)) : -1);
      }
    }
  }
  odds_.shift(from);
  moved_ = moved_ + by;
  bring_back();
  return by;
}

void LiveWindow::bring_back() {
  if (archive_.bricks() == 0) return;
  const Index3 n = map_.counts();
  for (int z = 0; z < n.z; ++z) {
    for (int y = 0; y < n.y; ++y) {
      for (int x = 0; x < n.x; ++x) {
        const Index3 brick{x, y, z};
        const auto kept = archive_.take(brick + moved_);
        if (!kept) continue;
        for (int row = 0; row < Brick::kWords; ++row) {
          map_.write(brick, row, kept->raw[std::size_t(row)], kept->known[std::size_t(row)]);
        }
      }
    }
  }
}

// The bricks of the window that rays of this scan may reach.
void LiveWindow::choose_box(const Scan& scan) {
  Vec3 low = to_voxels(scan.origins_map.front()), high = low;
  for (const Vec3& origin : scan.origins_map) {
    low = low.cwiseMin(to_voxels(origin));
    high = high.cwiseMax(to_voxels(origin));
  }
  const Vec3 middle = 0.5 * (low + high);
  // In steps of 8 voxels, so that the box keeps its size while the spread of origins varies.
  const Vec3 half = (((high - low) * 0.5 / 8.0).array().ceil() * 8.0 +
                     std::ceil(scan.max_range_m / resolution_m_) + 1.0)
                        .matrix();
  const Index3 n = map_.counts();
  box_empty_ = false;
  const auto choose = [&](double centre, double reach, int side, int all, int& lower, int& count) {
    if (centre + reach < 0.0 || centre - reach >= double(all) * side) box_empty_ = true;
    count = int(std::min(double(all), std::ceil(2.0 * reach / side) + 1.0));
    lower = int(std::clamp(std::floor((centre - reach) / side), 0.0, double(all - count)));
  };
  Index3 lower, counts;
  choose(middle.x(), half.x(), kBrickSize.x, n.x, lower.x, counts.x);
  choose(middle.y(), half.y(), kBrickSize.y, n.y, lower.y, counts.y);
  choose(middle.z(), half.z(), kBrickSize.z, n.z, lower.z, counts.z);
  rays_.begin(lower, counts);
}

void LiveWindow::insert(const Scan& scan, ScanResult& result) {
  result.points_left_out = 0;
  result.points_on_body = 0;
  result.points_far = 0;
  if (scan.points_map.empty()) return;
  choose_box(scan);
  cast(scan, result);
  integrate();
}

void LiveWindow::cast(const Scan& scan, ScanResult& result) {
  const bool one_origin = scan.origins_map.size() == 1;
  const double range = scan.max_range_m / resolution_m_;
  const double near = SensorWatch::kNear_m / resolution_m_;
  const bool has_body = scan.body_radius_m > 0.0 && !scan.body_path_map.empty();
  const Vec3 body = has_body ? to_voxels(scan.body_path_map.back()) : Vec3::Zero();
  const double body_radius = has_body ? scan.body_radius_m / resolution_m_ : -1.0;
  const BrickMap* held = options_.keep_grazed ? &map_ : nullptr;
  const Vec3 lower = lower_voxel();
  Vec3 from = to_voxels(scan.origins_map.front());
  for (std::size_t i = 0; i < scan.points_map.size(); ++i) {
    if (!one_origin) from = scan.origins_map[i] / resolution_m_ - lower;
    const Vec3 to = scan.points_map[i] / resolution_m_ - lower;
    const Vec3 ray = to - from;
    const double length_2 = ray.squaredNorm();
    result.points_far += std::int64_t(length_2 > near * near);
    // Many drivers write a missing return as the sensor's own place: it would block that voxel.
    if (!std::isfinite(length_2) || length_2 <= kShortest_voxels * kShortest_voxels) {
      ++result.points_left_out;
    } else if (has_body && (to - body).squaredNorm() < body_radius * body_radius) {
      ++result.points_on_body;
    } else if (!box_empty_) {
      const bool hits = length_2 <= range * range;
      const Vec3 end = hits ? to : Vec3(from + ray * (range / std::sqrt(length_2)));
      rays_.cast(from, end, hits, held);
    }
  }
}

void LiveWindow::integrate() {
  rays_.for_lines(
      [this](Index3 brick, int first_row, const BrickMap::Word* missed, const BrickMap::Word* hit) {
        const std::int32_t slot = odds_.open(flat(brick), map_.find(brick));
        for (int k = 0; k < RayScan::kLine; ++k) {
          if ((missed[k] | hit[k]) == 0) continue;
          const int row = first_row + k;
          const BrickMap::Bits* bits = map_.find(brick);
          BrickMap::Word raw = bits != nullptr ? bits->raw[std::size_t(row)] : 0;
          BrickMap::Word known = bits != nullptr ? bits->known[std::size_t(row)] : 0;
          odds_.step(slot, row, missed[k], hit[k], raw, known);
          map_.write(brick, row, raw, known);
        }
      });
}

void LiveWindow::clear_voxel(Index3 v) {
  const Index3 n = map_.size();
  if (unsigned(v.x) >= unsigned(n.x) || unsigned(v.y) >= unsigned(n.y) ||
      unsigned(v.z) >= unsigned(n.z)) {
    return;
  }
  const Index3 brick{v.x >> 6, v.y >> 3, v.z >> 3};
  const int row = 8 * (v.z & 7) + (v.y & 7);
  const BrickMap::Word bit = BrickMap::Word{1} << (v.x & 63);
  const BrickMap::Bits* bits = map_.find(brick);
  const BrickMap::Word raw = bits != nullptr ? bits->raw[std::size_t(row)] : 0;
  const BrickMap::Word known = bits != nullptr ? bits->known[std::size_t(row)] : 0;
  odds_.settle(odds_.open(flat(brick), bits), row, bit, 0);
  map_.write(brick, row, raw & ~bit, known | bit);
}

void LiveWindow::clear_body(std::span<const Vec3> path_map, double radius_m) {
  if (!(radius_m > 0.0)) return;
  const double radius = radius_m / resolution_m_;
  const Index3 n = map_.size();
  const Vec3 last(n.x - 1, n.y - 1, n.z - 1);
  for (const Vec3& p_map : path_map) {
    const Vec3 centre = to_voxels(p_map);
    // Cut to the window first: a body may be larger than it.
    const Index3 low = voxel_of((centre - Vec3::Constant(radius)).cwiseMax(Vec3::Zero()));
    const Index3 high = voxel_of((centre + Vec3::Constant(radius)).cwiseMin(last));
    clear_voxel(voxel_of(centre));
    for (int z = low.z; z <= high.z; ++z) {
      for (int y = low.y; y <= high.y; ++y) {
        for (int x = low.x; x <= high.x; ++x) {
          const Vec3 middle(x + 0.5, y + 0.5, z + 0.5);
          if ((middle - centre).squaredNorm() < radius * radius) clear_voxel({x, y, z});
        }
      }
    }
  }
}

void LiveWindow::list_changes(std::vector<Brick>& bricks) {
  const auto& changed = map_.regrow();
  bricks.resize(changed.size());
  for (std::size_t i = 0; i < changed.size(); ++i) bricks[i] = map_.brick(changed[i]);
}

std::int64_t LiveWindow::memory_bytes() const {
  return std::int64_t(map_.memory_bytes() + odds_.memory_bytes() + rays_.memory_bytes()) +
         archive_.memory_bytes();
}

}  // namespace goshawk::map_server
