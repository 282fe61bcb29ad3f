#include "goshawk/map_server/map_tools.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <optional>

namespace goshawk::map_server {
namespace {

using Word = BitGrid::Word;

Index3 raster_corner(const GridGeometry& geometry) {
  const Vec3 steps = (geometry.origin_map / geometry.resolution_m).array().round().matrix();
  return {int(steps.x()), int(steps.y()), int(steps.z())};
}

Status check_alike(std::span<const RawVoxels> maps) {
  if (maps.empty()) return fail(ErrorCode::invalid_input, "no map is given");
  const double resolution_m = maps.front().geometry.resolution_m;
  for (const RawVoxels& map : maps) {
    if (std::abs(map.geometry.resolution_m - resolution_m) > 1e-9 * resolution_m) {
      return fail(ErrorCode::invalid_input,
                  fmt::format("the maps have voxels of {:g} and {:g} m: they must be of one size",
                              resolution_m, map.geometry.resolution_m));
    }
  }
  return success();
}

/// The raster that covers all of them. @pre check_alike()
Result<GridGeometry> cover(std::span<const RawVoxels> maps, std::int64_t max_voxels) {
  const double res = maps.front().geometry.resolution_m;
  Index3 lower = raster_corner(maps.front().geometry), upper = lower;
  for (const RawVoxels& map : maps) {
    const Index3 first = raster_corner(map.geometry), end = first + map.geometry.size;
    lower = {std::min(lower.x, first.x), std::min(lower.y, first.y), std::min(lower.z, first.z)};
    upper = {std::max(upper.x, end.x), std::max(upper.y, end.y), std::max(upper.z, end.z)};
  }
  const auto metres = [&](Index3 i) -> Vec3 { return res * Vec3(i.x, i.y, i.z); };
  return raster_of({metres(lower), metres(upper)}, res, max_voxels);
}

/// What a map says of a row of another raster, 64 voxels at a time.
class Rows {
 public:
  Rows(const RawVoxels& map, const GridGeometry& raster)
      : map_(map), from_(raster_corner(raster) - raster_corner(map.geometry)) {}

  struct Bits {
    Word known = 0, occupied = 0;
  };
  Bits at(int word, int y, int z) const {
    const int my = y + from_.y, mz = z + from_.z;
    const Index3 n = map_.geometry.size;
    if (unsigned(my) >= unsigned(n.y) || unsigned(mz) >= unsigned(n.z)) return {};
    const std::int64_t x = std::int64_t{64} * word + from_.x;
    const Word known = map_.known.bits_from(x, my, mz);
    return {known, map_.occupied.bits_from(x, my, mz) & known};
  }

 private:
  const RawVoxels& map_;
  Index3 from_;
};

/// visit(word, y, z) for all words of a raster.
template <typename Visit>
void for_words(Index3 size, Visit&& visit) {
  for (int z = 0; z < size.z; ++z) {
    for (int y = 0; y < size.y; ++y) {
      for (int w = 0; 64 * w < size.x; ++w) visit(w, y, z);
    }
  }
}

void write(BitGrid& grid, int word, int y, int z, Word bits) {
  if (bits == 0) return;  // padding bits are those of a grid without any voxel set: kept
  grid.mutable_row(y, z)[word] |= bits;
}

void add(const RawVoxels& map, MergeRule rule, RawVoxels& all) {
  const Rows rows(map, all.geometry);
  for_words(all.geometry.size, [&](int w, int y, int z) {
    const Rows::Bits bits = rows.at(w, y, z);
    if (bits.known == 0) return;
    if (rule == MergeRule::later) {
      const Word freed =
          bits.known & ~bits.occupied & all.occupied.row(y, z)[w] & all.known.row(y, z)[w];
      if (freed != 0) all.occupied.mutable_row(y, z)[w] &= ~freed;
    }
    write(all.known, w, y, z, bits.known);
    write(all.occupied, w, y, z, bits.occupied);
  });
}

}  // namespace

Result<RawVoxels> merge(std::span<const RawVoxels> maps, MergeRule rule, std::int64_t max_voxels) {
  if (auto status = check_alike(maps); !status) return status.error();
  const auto geometry = cover(maps, max_voxels);
  if (!geometry) return geometry.error();
  RawVoxels all{*geometry, BitGrid(geometry->size, true), BitGrid(geometry->size, false)};
  for (const RawVoxels& map : maps) add(map, rule, all);
  return all;
}

Result<RawVoxels> trimmed(const RawVoxels& map) {
  constexpr int most = std::numeric_limits<int>::max();
  Index3 lower{most, most, most}, upper{0, 0, 0};
  const Rows rows(map, map.geometry);
  for_words(map.geometry.size, [&](int w, int y, int z) {
    const Word known = rows.at(w, y, z).known;
    if (known == 0) return;
    lower = {std::min(lower.x, 64 * w + std::countr_zero(known)), std::min(lower.y, y),
             std::min(lower.z, z)};
    upper = {std::max(upper.x, 64 * w + 64 - std::countl_zero(known)), std::max(upper.y, y + 1),
             std::max(upper.z, z + 1)};
  });
  if (upper.x == 0) return fail(ErrorCode::map_empty, "the map knows of no voxel");
  RawVoxels cut;
  cut.geometry = {map.geometry.lower_corner(lower), map.geometry.resolution_m, upper - lower};
  cut.occupied = map.occupied.window(lower, cut.geometry.size);
  cut.known = map.known.window(lower, cut.geometry.size);
  return cut;
}

Result<MapDifference> difference(const RawVoxels& before, const RawVoxels& after,
                                 std::int64_t max_voxels) {
  const std::array maps{before, after};  // they share their bits
  if (auto status = check_alike(maps); !status) return status.error();
  const auto geometry = cover(maps, max_voxels);
  if (!geometry) return geometry.error();
  MapDifference result;
  const Rows old_rows(before, *geometry), new_rows(after, *geometry);
  for_words(geometry->size, [&](int w, int y, int z) {
    const Rows::Bits a = old_rows.at(w, y, z), b = new_rows.at(w, y, z);
    const Word both = a.known & b.known;
    result.same += std::popcount(both & ~(a.occupied ^ b.occupied));
    result.appeared += std::popcount(both & ~a.occupied & b.occupied);
    result.vanished += std::popcount(both & a.occupied & ~b.occupied);
    result.learnt += std::popcount(b.known & ~a.known);
    result.forgotten += std::popcount(a.known & ~b.known);
  });
  return result;
}

}  // namespace goshawk::map_server
