#include "goshawk/runtime/map_subscription.hpp"

#include "goshawk/conversions/grid.hpp"

namespace goshawk::runtime {

MapSubscription::MapSubscription(Node& node, StageReporter& reporter, Callback on_map) {
  using Message = goshawk_msgs::msg::VoxelGrid;
  node.subscribe<Message>(
      "map/voxels", Qos::latched(),
      [this, &reporter, on_map = std::move(on_map)](const Message& m, const MessageInfo&) {
        auto grid = conversions::from_msg(m);
        if (!grid) return reporter.fault(grid.error());
        grid_ = std::make_shared<const VoxelGrid>(*std::move(grid));
        if (on_map) on_map(grid_);
      });
}

}  // namespace goshawk::runtime
