#pragma once

#include <cstdint>

#include "goshawk/map_server/live_map.hpp"
#include "goshawk/runtime/node.hpp"
#include "goshawk/stage/stage_reporter.hpp"
#include "goshawk_msgs.h"
#include "octomap_msgs.h"

namespace goshawk::map_server {

/// What a map server publishes: map/voxels, map/voxels/updates, octomap_binary, octomap_world.
class MapOutput {
 public:
  /// @param versions_before [versions] added to those of the map
  MapOutput(runtime::Node& node, stage::StageReporter& reporter, std::uint64_t versions_before,
            bool publish_raw);

  /// For late joiners. @param grid with raw voxels, and the version of the map
  void publish_whole(const VoxelGrid& grid);

  void add_versions_before(GridUpdate& update) const;
  /// @param update with the versions that are published
  void publish_update(GridUpdate& update);

  /// The window and what is kept beside it, once for each reader that comes: it may be large. Not
  /// in lock step.
  void publish_world_if_asked(const LiveMap& map, std::int64_t max_voxels);

 private:
  void publish_octomap(const VoxelGrid& grid);

  runtime::Node& node_;
  stage::StageReporter& reporter_;
  std::uint64_t versions_before_;
  bool publish_raw_;
  runtime::Publisher<goshawk_msgs::msg::VoxelGrid> voxels_;
  runtime::Publisher<goshawk_msgs::msg::VoxelGridUpdate> updates_;
  runtime::Publisher<octomap_msgs::msg::Octomap> octomap_, world_;
  int world_readers_ = 0;
};

}  // namespace goshawk::map_server
