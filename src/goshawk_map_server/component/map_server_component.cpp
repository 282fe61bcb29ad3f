#include <malloc.h>

#include <fmt/format.h>
#include <spdlog/logger.h>

#include <optional>

#include "beginning.hpp"
#include "cloud.hpp"
#include "goshawk/conversions/grid.hpp"
#include "goshawk/conversions/vehicle.hpp"
#include "goshawk/map_server/config.hpp"
#include "goshawk/map_server/live_map.hpp"
#include "goshawk/runtime/component.hpp"
#include "goshawk/stage/intake.hpp"
#include "octomap_msgs.h"

namespace goshawk::map_server {
namespace {

using namespace goshawk::runtime;
using namespace goshawk::stage;
namespace msg = goshawk_msgs::msg;

// How often, at the most, the whole map is published anew for late joiners while scans come in.
constexpr double kWholeMapPeriod_s = 1.0;

Beginning begin(const Config& config, Node& node) {
  auto beginning = begin_map(config);
  if (!beginning) throw StartupFault(beginning.error());
  for (const std::string& note : beginning->notes) node.log().warn("{}: {}", config.map_file, note);
  return *std::move(beginning);
}

/// A map file, and cloud_in -> map/voxels, map/voxels/updates, octomap_binary
class MapServerComponent : public Component {
 public:
  explicit MapServerComponent(Node& node)
      : node_(node),
        config_(node.parameters<Config>([this](const Config& c) {
          config_ = c;  // max_range_m of the scans to come
          return success();
        })),
        beginning_(begin(config_, node)),
        map_(std::move(beginning_.map)),
        reporter_(node, StageRole::map_server, "bricks"),
        voxels_(node.advertise<msg::VoxelGrid>("map/voxels", Qos::latched())),
        updates_(
            node.advertise<msg::VoxelGridUpdate>("map/voxels/updates", Qos::reliable_last(50))),
        octomap_(node.advertise<octomap_msgs::msg::Octomap>("octomap_binary", Qos::latched())) {
    node.subscribe<sensor_msgs::msg::PointCloud2>(
        "cloud_in", Qos::best_effort(2),
        [this](const sensor_msgs::msg::PointCloud2& m, const MessageInfo&) { on_cloud(m); });
    node.subscribe<nav_msgs::msg::Odometry>(
        "odom", Qos::best_effort(),
        [this](const nav_msgs::msg::Odometry& m, const MessageInfo&) {
          if (auto state = conversions::from_msg(m)) vehicle_ = *state;
        },
        Writers::one("odom"));
    node.every(kWholeMapPeriod_s, [this] {
      if (changed_) publish_whole();
      tell_of_journal();
    });
    publish_whole();
    malloc_trim(0);  // what loading and publishing took for a moment; glibc may keep it for ever
    const GridGeometry geometry = map_.geometry();
    reporter_.ready(fmt::format("serves {} voxels of {:.3g} m, obstacles inflated by {:.3g} m{}",
                                to_text(geometry.size), geometry.resolution_m,
                                map_.growth().inflation_m,
                                beginning_.bricks == 0
                                    ? ""
                                    : fmt::format("; {} bricks are from its journal",
                                                  beginning_.bricks)));
    if (beginning_.journal_fault) reporter_.fault(*beginning_.journal_fault);
  }

 private:
  void publish_whole() {
    changed_ = false;
    {
      msg::VoxelGrid m;  // freed at once: the writer keeps the bytes for late joiners
      m.header(conversions::make_header(node_.now_ns()));
      VoxelGrid published = map_.grid();  // shares its bits
      published.version += beginning_.versions_before;
      if (!config_.publish_raw) published.raw = {};
      conversions::fill_msg(published, m);
      reporter_.send(voxels_, m);
    }
    const auto bytes = map_.octomap_payload();
    if (!bytes) return reporter_.fault(bytes.error());
    octomap_msgs::msg::Octomap m;
    m.header(conversions::make_header(node_.now_ns()));
    m.binary(true);
    m.id("OcTree");
    m.resolution(map_.geometry().resolution_m);
    m.data().assign(bytes->begin(), bytes->end());
    reporter_.send(octomap_, m);
  }

  void on_cloud(const sensor_msgs::msg::PointCloud2& m) {
    auto points = points_in_map(m);
    if (!points) return reporter_.fault(points.error());
    if (points->empty()) return;
    const Vec3 origin = vehicle_->position_map;
    const Scan scan{.points_map = *points,
                    .origins_map = {&origin, 1},
                    .max_range_m = config_.max_range_m,
                    .body_path_map = {&origin, 1},
                    .body_radius_m = config_.body_radius_m};
    if (auto status = map_.insert_scan(scan, result_); !status) {
      return reporter_.fault(status.error());
    }
    GridUpdate& update = result_.update;
    update.from_version += beginning_.versions_before;
    update.to_version += beginning_.versions_before;
    if (beginning_.journal) {
      beginning_.journal->add(update.to_version, journal_bricks(update, map_.geometry()));
    }
    publish_update(update);
    changed_ = true;
  }

  void tell_of_journal() {
    if (!beginning_.journal) return;
    if (const auto fault = beginning_.journal->take_fault()) reporter_.fault(*fault);
  }

  // Clouds come in the body's frame, turned by the newest odometry, or in the map's.
  Result<std::vector<Vec3>> points_in_map(const sensor_msgs::msg::PointCloud2& m) const {
    if (!vehicle_) {
      return fail(ErrorCode::tracking_lost,
                  "a cloud came before any odometry, so its sensor's place is not known");
    }
    auto points = points_of(m);
    if (!points || m.header().frame_id() == conversions::kMapFrame) return points;
    if (auto s = conversions::check_frame(m.header(), conversions::kBodyFrame, "a cloud"); !s) {
      return s.error();
    }
    for (auto& p : *points) p = vehicle_->position_map + vehicle_->q_map_base * p;
    return points;
  }

  void publish_update(GridUpdate& update) {
    if (!config_.publish_raw) {
      for (Brick& brick : update.bricks) brick.raw.reset();
    }
    msg::VoxelGridUpdate m;
    m.header(conversions::make_header(node_.now_ns()));
    conversions::fill_msg(update, m);
    reporter_.send(updates_, m);
  }

  Node& node_;
  Config config_;
  Beginning beginning_;  // without its map
  LiveMap map_;
  ScanResult result_;  // its memory is used again
  StageReporter reporter_;
  Publisher<msg::VoxelGrid> voxels_;
  Publisher<msg::VoxelGridUpdate> updates_;
  Publisher<octomap_msgs::msg::Octomap> octomap_;
  std::optional<RigidBodyState> vehicle_;
  bool changed_ = false;
};

}  // namespace
}  // namespace goshawk::map_server

GOSHAWK_REGISTER_COMPONENT(goshawk::map_server::MapServerComponent, goshawk::map_server::Config)
