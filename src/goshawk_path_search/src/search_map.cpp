#include "goshawk/path_search/search_map.hpp"

#include <fmt/format.h>

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

// A row of a cut, 64 voxels at a time: word_at(x) gives those from x on.
template <typename WordAt>
void write_row(BitGrid& cut, int y, int z, const WordAt& word_at) {
  const int words = int(cut.words_per_row());
  const int used = cut.size().x % 64;
  const BitGrid::Word padding = used == 0 ? 0 : ~BitGrid::Word{0} << used;
  for (int w = 0; w < words; ++w) {
    BitGrid::Word word = word_at(64 * w);
    if (w + 1 == words) word = cut.outside() ? word | padding : word & ~padding;
    // A chunk that stays is not cloned.
    if (word != cut.row(y, z)[w]) cut.mutable_row(y, z)[w] = word;
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

Status SearchMap::place(const GridGeometry& g) {
  lower_ = {};
  derived_.geometry = g;
  if (!box_) return success();
  std::array<int, 3> from{}, count{};
  const std::array<int, 3> n = {g.size.x, g.size.y, g.size.z};
  for (int a = 0; a < 3; ++a) {
    const auto k = std::size_t(a);
    from[k] = first_not_below(box_->lower_map[a], g.origin_map[a], g.resolution_m, n[k]);
    // The next double above, so that a centre on the upper face is inside.
    const double above = std::nextafter(box_->upper_map[a], HUGE_VAL);
    count[k] = first_not_below(above, g.origin_map[a], g.resolution_m, n[k]) - from[k];
  }
  if (*std::ranges::min_element(count) <= 0) {
    return fail(ErrorCode::map_empty,
                fmt::format("search_box from {} to {} m holds no voxel of the map: choose another "
                            "box",
                            to_text(box_->lower_map), to_text(box_->upper_map)));
  }
  lower_ = {from[0], from[1], from[2]};
  derived_.geometry = {g.lower_corner(lower_), g.resolution_m, {count[0], count[1], count[2]}};
  return success();
}

// Rows of the derived grids whose source lies in a chunk that changed.
void SearchMap::derive(const VoxelGrid& map) {
  const Index3 size = derived_.geometry.size;
  const auto each_row = [&](BitGrid::Rows rows, auto&& visit) {
    const int z1 = std::min(rows.z1 - lower_.z, size.z), y1 = std::min(rows.y1 - lower_.y, size.y);
    for (int z = std::max(0, rows.z0 - lower_.z); z < z1; ++z) {
      for (int y = std::max(0, rows.y0 - lower_.y); y < y1; ++y) visit(y, z);
    }
  };
  const auto bits = [&](const BitGrid& grid, int x, int y, int z) {
    return grid.bits_from(lower_.x + x, lower_.y + y, lower_.z + z);
  };
  const auto write_grown = [&](int y, int z) {
    write_row(derived_.grown, y, z, [&](int x) {
      const BitGrid::Word grown = bits(map.grown, x, y, z);
      return blocks_unknown_ ? grown | ~bits(map.known, x, y, z) : grown;
    });
  };
  const auto write_known = [&](int y, int z) {
    write_row(derived_.known, y, z, [&](int x) { return bits(map.known, x, y, z); });
  };
  for_changed_chunks(source_->grown, map.grown,
                     [&](BitGrid::Rows rows) { each_row(rows, write_grown); });
  if (map.known.empty()) return;
  for_changed_chunks(source_->known, map.known, [&](BitGrid::Rows rows) {
    if (blocks_unknown_) each_row(rows, write_grown);
    each_row(rows, write_known);
  });
}

// As if derived from a map that is free and unknown throughout.
Status SearchMap::begin(const VoxelGrid& map) {
  source_.reset();
  if (auto status = place(map.geometry); !status) return status;
  const Index3 size = map.geometry.size, cut = derived_.geometry.size;
  auto before = std::make_shared<VoxelGrid>();
  before->geometry = map.geometry;
  before->grown = BitGrid(size, true);
  derived_.grown = BitGrid(cut, true, blocks_unknown_);
  derived_.known = {};
  if (!map.known.empty()) {
    before->known = BitGrid(size, false);
    derived_.known = BitGrid(cut, false);
  }
  source_ = std::move(before);
  return success();
}

Result<std::shared_ptr<const VoxelGrid>> SearchMap::follow(std::shared_ptr<const VoxelGrid> map) {
  const bool wants_unknown = unknown_ == UnknownRule::free || unknown_ == UnknownRule::costly;
  if (wants_unknown && map->unknown_is_occupied && !map->known.empty()) {
    return fail(ErrorCode::invalid_parameter,
                fmt::format("unknown is {}, but the map counts unknown space as occupied: set "
                            "map_server's unknown to free, or path_search's to as_mapped",
                            to_word(unknown_)));
  }
  const bool blocks =
      unknown_ == UnknownRule::blocked && !map->unknown_is_occupied && !map->known.empty();
  if (!box_ && !blocks) return map;
  const bool follows = source_ != nullptr && blocks == blocks_unknown_ &&
                       source_->geometry == map->geometry &&
                       source_->known.empty() == map->known.empty();
  blocks_unknown_ = blocks;
  if (!follows) {
    if (auto status = begin(*map); !status) return status.error();
  }
  derive(*map);
  derived_.version = map->version;
  derived_.inflation_m = map->inflation_m;
  derived_.unknown_is_occupied = map->unknown_is_occupied || blocks;
  derived_.unknown_grows = map->unknown_grows;
  source_ = std::move(map);
  return std::shared_ptr<const VoxelGrid>(std::make_shared<VoxelGrid>(derived_));
}

}  // namespace goshawk::path_search
