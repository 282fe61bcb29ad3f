#pragma once

#include <functional>
#include <memory>

#include "goshawk/core/grid_geometry.hpp"
#include "goshawk/runtime/stage_reporter.hpp"

namespace goshawk::runtime {

/// Keeps a stage's copy of the map up to date from `map/voxels`. A message that is not a valid
/// grid is reported on stage_report, and the grid before it stays.
class MapSubscription {
 public:
  using Callback = std::function<void(const std::shared_ptr<const VoxelGrid>&)>;

  /// @param on_map called with every new grid, in the node's thread
  MapSubscription(Node& node, StageReporter& reporter, Callback on_map = {});

  /// @return the newest grid, or nullptr before the first
  const std::shared_ptr<const VoxelGrid>& grid() const { return grid_; }

 private:
  std::shared_ptr<const VoxelGrid> grid_;
};

}  // namespace goshawk::runtime
