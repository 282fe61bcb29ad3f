#pragma once

#include <functional>
#include <memory>

#include "goshawk/core/grid_geometry.hpp"
#include "goshawk/stage/stage_reporter.hpp"

namespace goshawk::stage {

/// Keeps a stage's map up to date from `map/voxels` and `map/voxels/updates`. Each version shares
/// what did not change with the one before it, so that a stage follows by looking at changed chunks
/// only (goshawk::for_changed_chunks). A message that is wrong is reported on stage_report, and the
/// grid before it stays. An update that does not follow on the version here is dropped: the whole
/// map comes again soon after.
class MapSubscription {
 public:
  using Callback = std::function<void(const std::shared_ptr<const VoxelGrid>&)>;
  using FaultCallback = std::function<void(const Error&)>;

  /// Faults go to stage_report.
  /// @param on_map called with every new grid, in the node's thread
  MapSubscription(runtime::Node& node, StageReporter& reporter, Callback on_map = {});
  /// @param on_fault called with what is wrong with a message, in the node's thread
  MapSubscription(runtime::Node& node, Callback on_map, FaultCallback on_fault);

  /// @return the newest grid, or nullptr before the first
  const std::shared_ptr<const VoxelGrid>& grid() const { return grid_; }

 private:
  void on_grid(const goshawk_msgs::msg::VoxelGrid& m);
  void on_update(const goshawk_msgs::msg::VoxelGridUpdate& m);
  void take(VoxelGrid grid);

  Callback on_map_;
  FaultCallback on_fault_;
  std::shared_ptr<const VoxelGrid> grid_;
};

}  // namespace goshawk::stage
