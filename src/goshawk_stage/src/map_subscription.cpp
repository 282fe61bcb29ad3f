#include "goshawk/stage/map_subscription.hpp"

#include "goshawk/conversions/grid.hpp"

namespace goshawk::stage {

namespace msg = goshawk_msgs::msg;

MapSubscription::MapSubscription(runtime::Node& node, StageReporter& reporter, Callback on_map)
    : MapSubscription(node, std::move(on_map),
                      [&reporter](const Error& error) { reporter.fault(error); }) {}

MapSubscription::MapSubscription(runtime::Node& node, Callback on_map, FaultCallback on_fault)
    : on_map_(std::move(on_map)), on_fault_(std::move(on_fault)) {
  node.subscribe<msg::VoxelGrid>(
      "map/voxels", runtime::Qos::latched(),
      [this](const msg::VoxelGrid& m, const runtime::MessageInfo&) { on_grid(m); },
      runtime::Writers::one("map"));
  node.subscribe<msg::VoxelGridUpdate>(
      "map/voxels/updates", runtime::Qos::reliable_last(50),
      [this](const msg::VoxelGridUpdate& m, const runtime::MessageInfo&) { on_update(m); },
      runtime::Writers::one("map"));
}

void MapSubscription::on_grid(const msg::VoxelGrid& m) {
  auto grid = conversions::from_msg(m);
  if (!grid) return on_fault_(grid.error());
  if (grid_ != nullptr) {
    grid->grown.share_equal_chunks(grid_->grown);
    grid->known.share_equal_chunks(grid_->known);
    grid->raw.share_equal_chunks(grid_->raw);
  }
  take(*std::move(grid));
}

void MapSubscription::on_update(const msg::VoxelGridUpdate& m) {
  if (grid_ == nullptr || grid_->version != m.from_version()) return;
  const auto update = conversions::from_msg(m);
  if (!update) return on_fault_(update.error());
  VoxelGrid grid = *grid_;  // shares its bits
  if (auto status = apply(grid, *update); !status) return on_fault_(status.error());
  take(std::move(grid));
}

void MapSubscription::take(VoxelGrid grid) {
  grid_ = std::make_shared<const VoxelGrid>(std::move(grid));
  if (on_map_) on_map_(grid_);
}

}  // namespace goshawk::stage
