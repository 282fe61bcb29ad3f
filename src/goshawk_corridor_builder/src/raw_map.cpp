#include "goshawk/corridor_builder/raw_map.hpp"

#include <utility>

namespace goshawk::corridor_builder {

RawMap::RawMap(VoxelGrid raw) : raw_(std::move(raw)) {
  if (!raw_.unknown_is_occupied || raw_.known.empty()) return;
  const Index3 size = raw_.known.size();
  unknown_ = BitGrid(size, true);
  for (int z = 0; z < size.z; ++z) {
    for (int y = 0; y < size.y; ++y) {
      // The padding of `known` is clear, that of `unknown_` set.
      const BitGrid::Word* known = raw_.known.row(y, z);
      BitGrid::Word* unknown = unknown_.mutable_row(y, z);
      for (std::size_t w = 0; w < unknown_.words_per_row(); ++w) unknown[w] = ~known[w];
    }
  }
}

RawObstacles RawMap::obstacles(double radius_m) const {
  return {&raw_.occupied, radius_m, unknown_.empty() ? nullptr : &unknown_};
}

}  // namespace goshawk::corridor_builder
