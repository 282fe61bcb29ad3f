// The voxel maps of Brewer and Sturtevant, "Benchmarks for Pathfinding in 3D Voxel Space", SoCS
// 2018: a line "voxel X Y Z" with the size, then a line "x y z" for each occupied voxel.

#include <optional>

#include "readers.hpp"
#include "text.hpp"

namespace goshawk::map_server {
namespace {

std::optional<Index3> read_index(const std::vector<std::string_view>& words, std::size_t from) {
  if (words.size() != from + 3) return {};
  const auto x = parse<int>(words[from]);
  const auto y = parse<int>(words[from + 1]);
  const auto z = parse<int>(words[from + 2]);
  if (!x || !y || !z) return {};
  return Index3{*x, *y, *z};
}

bool inside(Index3 i, Index3 size) {
  return i.x >= 0 && i.y >= 0 && i.z >= 0 && i.x < size.x && i.y < size.y && i.z < size.z;
}

}  // namespace

Result<WarframeMap> read_warframe(std::string_view bytes) {
  TextReader reader(bytes);
  const auto first = split(reader.line());
  if (first.empty() || first[0] != "voxel") {
    return malformed("the first line is not 'voxel X Y Z': it is no .3dmap file");
  }
  const auto size = read_index(first, 1);
  if (!size || size->x < 1 || size->y < 1 || size->z < 1) {
    return malformed("the first line gives no size: it must be 'voxel X Y Z', each 1 or more");
  }
  WarframeMap map;
  map.size = *size;
  for (std::size_t number = 2; !reader.done(); ++number) {
    const auto words = split(reader.line());
    if (words.empty()) continue;
    const auto voxel = read_index(words, 0);
    if (!voxel || !inside(*voxel, *size)) {
      return malformed("line " + std::to_string(number) + " is no voxel of this map of " +
                       to_text(*size));
    }
    map.occupied.push_back(*voxel);
  }
  return map;
}

}  // namespace goshawk::map_server
