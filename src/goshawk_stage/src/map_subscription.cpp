#include "goshawk/stage/map_subscription.hpp"

#include "goshawk/conversions/grid.hpp"

namespace goshawk::stage {

namespace msg = goshawk_msgs::msg;

MapSubscription::MapSubscription(runtime::Node& node, StageReporter& reporter, Callback on_map)
    : reporter_(reporter), on_map_(std::move(on_map)) {
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
  if (!grid) return reporter_.fault(grid.error());
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
  if (!update) return reporter_.fault(update.error());
  VoxelGrid grid = *grid_;  // shares its bits
  if (auto status = apply(grid, *update); !status) return reporter_.fault(status.error());
  take(std::move(grid));
}

void MapSubscription::take(VoxelGrid grid) {
  grid_ = std::make_shared<const VoxelGrid>(std::move(grid));
  if (on_map_) on_map_(grid_);
}

}  // namespace goshawk::stage
