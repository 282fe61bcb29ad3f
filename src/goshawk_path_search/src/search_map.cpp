#include "goshawk/path_search/search_map.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

namespace goshawk::path_search {
namespace {

// First voxel whose centre is not below the bound, along one axis; at most n.
int first_not_below(double bound_m, double origin_m, double resolution_m, int n) {
  const double i = std::ceil((bound_m - origin_m) / resolution_m - 0.5);
  return int(std::clamp(i, 0.0, double(n)));
}

BitGrid crop(const BitGrid& grid, Index3 lower, Index3 size) {
  BitGrid cut(size, grid.outside());
  for (int z = 0; z < size.z; ++z) {
    for (int y = 0; y < size.y; ++y) {
      for (int x = 0; x < size.x; ++x) {
        if (grid.get(lower + Index3{x, y, z})) cut.set({x, y, z}, true);
      }
    }
  }
  return cut;
}

Result<VoxelGrid> crop(const VoxelGrid& map, const SearchBox& box) {
  const GridGeometry& g = map.geometry;
  std::array<int, 3> from{}, count{};
  const std::array<int, 3> n = {g.size.x, g.size.y, g.size.z};
  for (int a = 0; a < 3; ++a) {
    const auto k = std::size_t(a);
    from[k] = first_not_below(box.lower_map[a], g.origin_map[a], g.resolution_m, n[k]);
    // The next double above, so that a centre on the upper face is inside.
    const double above = std::nextafter(box.upper_map[a], HUGE_VAL);
    count[k] = first_not_below(above, g.origin_map[a], g.resolution_m, n[k]) - from[k];
  }
  if (*std::ranges::min_element(count) <= 0) {
    return fail(ErrorCode::map_empty, "search_box from " + to_text(box.lower_map) + " to " +
                                          to_text(box.upper_map) +
                                          " m holds no voxel of the map: choose another box");
  }
  const Index3 lower{from[0], from[1], from[2]}, size{count[0], count[1], count[2]};
  VoxelGrid cut = {.geometry = {g.lower_corner(lower), g.resolution_m, size},
                   .occupied = crop(map.occupied, lower, size),
                   .known = {},
                   .version = map.version,
                   .inflation_m = map.inflation_m,
                   .unknown_is_occupied = map.unknown_is_occupied};
  if (!map.known.empty()) cut.known = crop(map.known, lower, size);
  return cut;
}

void block_unknown(VoxelGrid& map) {
  const auto unknown = unknown_voxels(map);
  map.unknown_is_occupied = true;
  if (!unknown) return;
  for (int z = 0; z < map.geometry.size.z; ++z) {
    for (int y = 0; y < map.geometry.size.y; ++y) {
      BitGrid::Word* row = map.occupied.mutable_row(y, z);
      const BitGrid::Word* add = unknown->row(y, z);
      for (std::size_t w = 0; w < map.occupied.words_per_row(); ++w) row[w] |= add[w];
    }
  }
}

}  // namespace

Result<std::optional<SearchBox>> parse_search_box(const std::string& text) {
  if (text.empty()) return std::optional<SearchBox>();
  std::array<double, 6> v{};
  const char* at = text.data();
  const char* end = at + text.size();
  for (std::size_t k = 0; k < 6; ++k) {
    if (k > 0 && (at == end || *at++ != ',')) at = nullptr;
    while (at != nullptr && at != end && *at == ' ') ++at;
    const auto [rest, error] = at == nullptr
                                   ? std::from_chars_result{nullptr, std::errc::invalid_argument}
                                   : std::from_chars(at, end, v[k]);
    at = rest;
    if (error != std::errc() || !std::isfinite(v[k])) {
      return fail(ErrorCode::invalid_parameter,
                  "search_box is '" + text + "': it must be six numbers, x0,y0,z0,x1,y1,z1 [m]");
    }
  }
  const SearchBox box{{v[0], v[1], v[2]}, {v[3], v[4], v[5]}};
  if (at != end || !(box.lower_map.array() < box.upper_map.array()).all()) {
    return fail(ErrorCode::invalid_parameter,
                "search_box is '" + text +
                    "': six numbers, x0,y0,z0,x1,y1,z1 [m], the first three below the others");
  }
  return std::optional(box);
}

std::optional<BitGrid> unknown_voxels(const VoxelGrid& map) {
  if (map.known.empty()) return {};
  BitGrid unknown(map.geometry.size, false);
  for (int z = 0; z < map.geometry.size.z; ++z) {
    for (int y = 0; y < map.geometry.size.y; ++y) {
      for (int x = 0; x < map.geometry.size.x; ++x) {
        if (!map.known.get({x, y, z})) unknown.set({x, y, z}, true);
      }
    }
  }
  return unknown;
}

Result<std::shared_ptr<const VoxelGrid>> make_search_map(std::shared_ptr<const VoxelGrid> map,
                                                         const Config& config,
                                                         const std::optional<SearchBox>& box) {
  const bool wants_unknown =
      config.unknown == UnknownRule::free || config.unknown == UnknownRule::costly;
  if (wants_unknown && map->unknown_is_occupied && !map->known.empty()) {
    return fail(ErrorCode::invalid_parameter,
                "unknown is " + std::string(to_word(config.unknown)) +
                    ", but the map counts unknown space as occupied: set map_server's unknown to "
                    "free, or path_search's to as_mapped");
  }
  const bool blocks = config.unknown == UnknownRule::blocked && !map->unknown_is_occupied;
  if (!box && !blocks) return map;
  VoxelGrid own;
  if (box) {
    auto cut = crop(*map, *box);
    if (!cut) return cut.error();
    own = *std::move(cut);
  } else {
    own = *map;
  }
  if (blocks) block_unknown(own);
  return std::shared_ptr<const VoxelGrid>(std::make_shared<VoxelGrid>(std::move(own)));
}

}  // namespace goshawk::path_search
