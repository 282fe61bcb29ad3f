#include "map_growth.hpp"

#include <cmath>
#include <optional>

#include "runs.hpp"

namespace goshawk::flight_report {
namespace {

constexpr std::int64_t kMostVoxels = 30'000'000;  // that a page holds twice, a byte each

/// Where a window's first voxel lies on the raster of another window; nothing if their rasters or
/// the words of their rows do not fall together.
std::optional<Index3> offset_of(const GridGeometry& window, const GridGeometry& base) {
  if (window.resolution_m != base.resolution_m) return {};
  const Vec3 at = base.to_grid(window.origin_map);
  const Vec3 whole = at.array().round();
  if ((at - whole).cwiseAbs().maxCoeff() > 1e-3 || whole.cwiseAbs().maxCoeff() > 1e8) return {};
  const Index3 offset{int(whole.x()), int(whole.y()), int(whole.z())};
  if (offset.x % BitGrid::kWordBits != 0) return {};
  return offset;
}

/// A moment whose window has a place on the common raster.
struct Placed {
  const MapMoment* moment;
  Index3 offset;
};

/// From the raster of the last window to the one around all of them.
GridGeometry place_all(std::vector<Placed>& all, const GridGeometry& last) {
  Index3 lower = all.front().offset, upper = lower;
  for (const auto& [moment, offset] : all) {
    const Index3 size = moment->grid.geometry.size;
    lower = {std::min(lower.x, offset.x), std::min(lower.y, offset.y), std::min(lower.z, offset.z)};
    upper = {std::max(upper.x, offset.x + size.x), std::max(upper.y, offset.y + size.y),
             std::max(upper.z, offset.z + size.z)};
  }
  for (Placed& placed : all) placed.offset = placed.offset - lower;
  return {last.lower_corner(lower), last.resolution_m, upper - lower};
}

/// Writes one window's bits over what was known before. @param mask of the bits that count
void overwrite(BitGrid& world, const BitGrid& window, const BitGrid& mask, Index3 offset) {
  const Index3 size = window.size();
  for (int z = 0; z < size.z; ++z) {
    for (int y = 0; y < size.y; ++y) {
      const BitGrid::Word* from = window.row(y, z);
      const BitGrid::Word* counts = mask.row(y, z);
      BitGrid::Word* to = world.mutable_row(y + offset.y, z + offset.z) + offset.x / 64;
      for (int x = 0; x < size.x; x += 64) {
        const int bits = std::min(64, size.x - x);
        const BitGrid::Word inside = ~BitGrid::Word{0} >> (64 - bits);
        to[x / 64] = (to[x / 64] & ~inside) | (from[x / 64] & counts[x / 64] & inside);
      }
    }
  }
}

std::string flipped(const BitGrid& before, const BitGrid& after) {
  BitGrid changes(after.size(), false);
  for_changed_chunks(before, after, [&](const BitGrid::Rows& rows) {
    for (int z = rows.z0; z < rows.z1; ++z) {
      for (int y = rows.y0; y < rows.y1; ++y) {
        BitGrid::Word* row = changes.mutable_row(y, z);
        for (std::size_t w = 0; w < after.words_per_row(); ++w) {
          row[w] = before.row(y, z)[w] ^ after.row(y, z)[w];
        }
      }
    }
  });
  return runs_of(changes);
}

}  // namespace

MapGrowth growth_of(std::span<const MapMoment> moments) {
  if (moments.empty()) return {};
  const GridGeometry& last = moments.back().grid.geometry;
  std::vector<Placed> all;
  for (const MapMoment& moment : moments) {
    const auto offset = offset_of(moment.grid.geometry, last);
    if (offset && !moment.grid.known.empty()) all.push_back({&moment, *offset});
  }
  if (all.empty()) return {};
  MapGrowth growth{place_all(all, last), {}};
  const Index3 size = growth.geometry.size;
  if (double(size.x) * size.y * size.z > double(kMostVoxels)) return {};
  BitGrid obstacles(size, false), known(size, false);
  for (const auto& [moment, offset] : all) {
    const VoxelGrid& grid = moment->grid;
    const BitGrid obstacles_before = obstacles, known_before = known;
    overwrite(obstacles, grid.raw.empty() ? grid.grown : grid.raw, grid.known, offset);
    overwrite(known, grid.known, grid.known, offset);
    growth.changes.push_back({moment->t_s, offset, grid.geometry.size,
                              flipped(obstacles_before, obstacles), flipped(known_before, known)});
  }
  return growth;
}

}  // namespace goshawk::flight_report
