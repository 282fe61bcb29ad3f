#include "map_output.hpp"

#include "goshawk/conversions/grid.hpp"
#include "goshawk/map_server_messages/octomap.hpp"

namespace goshawk::map_server {

using goshawk_msgs::msg::VoxelGridUpdate;
using octomap_msgs::msg::Octomap;
using runtime::Qos;

MapOutput::MapOutput(runtime::Node& node, stage::StageReporter& reporter,
                     std::uint64_t versions_before, bool publish_raw)
    : node_(node),
      reporter_(reporter),
      versions_before_(versions_before),
      publish_raw_(publish_raw),
      voxels_(node.advertise<goshawk_msgs::msg::VoxelGrid>("map/voxels", Qos::latched())),
      updates_(node.advertise<VoxelGridUpdate>("map/voxels/updates", Qos::reliable_last(50))),
      octomap_(node.advertise<Octomap>("octomap_binary", Qos::latched())),
      world_(node.advertise<Octomap>("octomap_world", Qos::reliable_last(1))) {}

void MapOutput::publish_whole(const VoxelGrid& grid) {
  VoxelGrid published = grid;  // shares its bits
  published.version += versions_before_;
  if (!publish_raw_) published.raw = {};
  goshawk_msgs::msg::VoxelGrid m;
  m.header(conversions::make_header(node_.now_ns()));
  conversions::fill_msg(published, m);
  reporter_.send(voxels_, m);
  publish_octomap(grid);
}

void MapOutput::publish_octomap(const VoxelGrid& grid) {
  Octomap m;
  m.header(conversions::make_header(node_.now_ns()));
  if (auto s = fill_octomap(grid.geometry, grid.raw, grid.known, m); !s) {
    return reporter_.fault(s.error());
  }
  reporter_.send(octomap_, m);
}

void MapOutput::add_versions_before(GridUpdate& update) const {
  update.from_version += versions_before_;
  update.to_version += versions_before_;
}

void MapOutput::publish_update(GridUpdate& update) {
  if (!publish_raw_) {
    for (Brick& brick : update.bricks) brick.raw.reset();
  }
  VoxelGridUpdate m;
  m.header(conversions::make_header(node_.now_ns()));
  conversions::fill_msg(update, m);
  reporter_.send(updates_, m);
}

void MapOutput::publish_world_if_asked(const LiveMap& map, std::int64_t max_voxels) {
  if (node_.in_lock_step()) return;  // when a reader is found does not repeat
  const int readers = world_.matched();
  const bool come = readers > world_readers_;
  world_readers_ = readers;
  if (!come) return;
  const auto world = map.world(max_voxels);
  if (!world) return reporter_.fault(world.error());
  Octomap m;
  m.header(conversions::make_header(node_.now_ns()));
  if (auto s = fill_octomap(world->geometry, world->occupied, world->known, m); !s) {
    return reporter_.fault(s.error());
  }
  reporter_.send(world_, m);
}

}  // namespace goshawk::map_server
