#pragma once

#include "goshawk/core/grid_geometry.hpp"
#include "goshawk/corridor_builder/corridor_builder.hpp"

namespace goshawk::corridor_builder {

/// Owns what the margin `sphere` needs of a map: obstacles before they were grown, and, where
/// unknown space counts as occupied, the voxels that were never measured.
class RawMap {
 public:
  /// @param raw what was grown, not grown itself
  explicit RawMap(VoxelGrid raw);

  std::uint64_t version() const { return raw_.version; }
  /// @param radius_m [m] what the grown grid was grown by
  RawObstacles obstacles(double radius_m) const;

 private:
  VoxelGrid raw_;
  BitGrid unknown_;  // empty where nothing is unknown, or unknown space is free
};

}  // namespace goshawk::corridor_builder
