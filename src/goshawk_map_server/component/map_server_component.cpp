#include <malloc.h>

#include <fmt/format.h>
#include <spdlog/logger.h>

#include <bit>
#include <deque>
#include <map>
#include <optional>

#include "beginning.hpp"
#include "goshawk/conversions/vehicle.hpp"
#include "goshawk/map_server/config.hpp"
#include "goshawk/map_server/frame_tree.hpp"
#include "goshawk/map_server/live_map.hpp"
#include "goshawk/map_server/placement.hpp"
#include "goshawk/map_server/sensor_watch.hpp"
#include "goshawk/map_server_messages/cloud.hpp"
#include "goshawk/map_server_messages/depth_image.hpp"
#include "goshawk/map_server_messages/octomap.hpp"
#include "goshawk/map_server_messages/transform.hpp"
#include "goshawk/runtime/clock.hpp"
#include "goshawk/runtime/component.hpp"
#include "goshawk/stage/intake.hpp"
#include "map_output.hpp"
#include "octomap_msgs.h"
#include "tf2_msgs.h"

namespace goshawk::map_server {
namespace {

using namespace goshawk::runtime;
using namespace goshawk::stage;
namespace msg = goshawk_msgs::msg;

// How often, at the most, the whole map is published anew for late joiners while scans come in.
constexpr double kWholeMapPeriod_s = 1.0;
// After the last change it is repeated 1, 2, 4, 8 and 16 periods later: DDS does not send it again
// to a reader that was deaf for longer than its lease, while the map server heard it all the time.
constexpr unsigned kLastRepeat = 16;
// How long poses are kept: clouds that come later are refused.
constexpr double kPosesKept_s = 5.0;
constexpr std::size_t kMostWaiting = 8;   // clouds that wait for odometry
constexpr std::size_t kMostCameras = 16;  // frames whose CameraInfo is kept
constexpr double kWaitingPeriod_s = 0.05;

Beginning begin(const Config& config, Node& node) {
  // The machine's clock, also in simulated time, which begins anew.
  auto beginning = begin_map(config, SystemClock().now_ns());
  if (!beginning) throw StartupFault(beginning.error());
  for (const std::string& note : beginning->notes) node.log().warn("{}: {}", config.map_file, note);
  return *std::move(beginning);
}

/// A map file; cloud_in, depth_in and depth_info_in, octomap_in, odom, /tf and /tf_static ->
/// map/voxels, map/voxels/updates, octomap_binary, octomap_world
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
        // With a reserve, what is flown is judged by raw voxels (goshawk::FreeSpace).
        output_(node, reporter_, beginning_.versions_before,
                config_.publish_raw || config_.reserve_m > 0.0),
        odometry_("odometry", kPosesKept_s, config_.pose_max_gap_s),
        frames_(kPosesKept_s, config_.pose_max_gap_s),
        watch_(config_.sensor_timeout_s) {
    subscribe();
    if (!config_.sensor_frame.empty()) {
      frames_.set_static(std::string(conversions::kBodyFrame), config_.sensor_frame,
                         sensor_mount(config_));
    }
    node.every(kWaitingPeriod_s, [this] {
      place_waiting();
      tell_of_sensors();
      output_.publish_world_if_asked(map_, config_.max_voxels);
    });
    node.every(kWholeMapPeriod_s, [this] {
      publish_whole_if_due();
      tell_of_journal();
    });
    publish_whole();
    malloc_trim(0);  // what loading and publishing took for a moment; glibc may keep it for ever
    const GridGeometry geometry = map_.geometry();
    reporter_.ready(
        fmt::format("serves {} voxels of {:.3g} m, obstacles inflated by {:.3g} m{}",
                    to_text(geometry.size), geometry.resolution_m, map_.growth().inflation_m,
                    beginning_.bricks == 0
                        ? ""
                        : fmt::format("; {} bricks are from its journal", beginning_.bricks)));
    if (beginning_.journal_fault) reporter_.fault(*beginning_.journal_fault);
    tell_of_forgotten();
  }

 private:
  void subscribe() {
    node_.subscribe<sensor_msgs::msg::PointCloud2>(
        "cloud_in", Qos::best_effort(2),
        [this](const sensor_msgs::msg::PointCloud2& m, const MessageInfo&) { on_cloud(m); },
        sensor("cloud_in"));
    node_.subscribe<sensor_msgs::msg::CameraInfo>(
        "depth_info_in", Qos::best_effort(2),
        [this](const sensor_msgs::msg::CameraInfo& m, const MessageInfo&) { on_camera(m); },
        sensor("depth_info_in"));
    node_.subscribe<sensor_msgs::msg::Image>(
        "depth_in", Qos::best_effort(2),
        [this](const sensor_msgs::msg::Image& m, const MessageInfo&) { on_depth(m); },
        sensor("depth_in"));
    node_.subscribe<octomap_msgs::msg::Octomap>(
        "octomap_in", Qos::reliable_last(1),
        [this](const octomap_msgs::msg::Octomap& m, const MessageInfo&) { on_map(m); });
    node_.subscribe<nav_msgs::msg::Odometry>(
        "odom", Qos::best_effort(50),
        [this](const nav_msgs::msg::Odometry& m, const MessageInfo&) { on_odometry(m); },
        Writers::one("odom"));
    node_.subscribe<tf2_msgs::msg::TFMessage>(
        "/tf_static", Qos::latched(100),
        [this](const tf2_msgs::msg::TFMessage& m, const MessageInfo&) { on_frames(m, true); });
    node_.subscribe<tf2_msgs::msg::TFMessage>(
        "/tf", Qos::best_effort(100),
        [this](const tf2_msgs::msg::TFMessage& m, const MessageInfo&) { on_frames(m, false); });
  }

  Writers sensor(const char* topic) const {
    return config_.any_sensor ? Writers::any() : Writers::one(topic);
  }

  void publish_whole_if_due() {
    if (changed_) periods_since_change_ = 0;
    if (changed_ ||
        (periods_since_change_ <= kLastRepeat && std::has_single_bit(periods_since_change_))) {
      publish_whole();
    }
    if (periods_since_change_ <= kLastRepeat) ++periods_since_change_;
  }

  void publish_whole() {
    changed_ = false;
    output_.publish_whole(map_.grid());
  }

  // A map from elsewhere. The answer's request is the stamp of the message.
  void on_map(const octomap_msgs::msg::Octomap& m) {
    const auto request_id = std::uint64_t(conversions::to_ns(m.header().stamp()));
    const auto status = take_map(m);
    if (!status) return reporter_.failed(request_id, status.error());
    reporter_.answered(request_id, {}, {{"bricks", double(result_.update.bricks.size())}},
                       "the map was taken");
  }

  Status take_map(const octomap_msgs::msg::Octomap& m) {
    if (m.header().frame_id() != conversions::kMapFrame) {
      return fail(ErrorCode::wrong_frame,
                  fmt::format("the map on octomap_in is in frame '{}', not in '{}'",
                              m.header().frame_id(), conversions::kMapFrame));
    }
    const auto map = read_octomap(m);
    if (!map) return map.error();
    if (auto status = map_.insert_map(*map, result_.update); !status) return status;
    tell_of_forgotten();
    // What lies outside of the window is in no update.
    if (beginning_.journal) {
      beginning_.journal->add(result_.update.to_version + beginning_.versions_before,
                              map_.bricks_outside());
    }
    publish_changes();
    return success();
  }

  void on_odometry(const nav_msgs::msg::Odometry& m) {
    const auto status = take_odometry(m);
    // Odometry comes fast: the same fault is told once.
    const ErrorCode code = status ? ErrorCode::ok : status.code();
    if (code == odometry_code_) return;
    odometry_code_ = code;
    if (!status) reporter_.fault(status.error());
  }

  Status take_odometry(const nav_msgs::msg::Odometry& m) {
    const auto state = conversions::from_msg(m);
    if (!state) return state.error();
    const auto status = odometry_.add(conversions::to_ns(m.header().stamp()),
                                      {state->position_map, state->q_map_base});
    if (!status) placed_ns_ = 0;
    place_waiting();
    return status;
  }

  void on_frames(const tf2_msgs::msg::TFMessage& m, bool fixed) {
    for (const auto& t : m.transforms()) {
      // The vehicle's own pose comes as odometry.
      if (t.child_frame_id() == conversions::kBodyFrame) continue;
      // What a parameter says of the mount, nobody else says.
      if (t.child_frame_id() == config_.sensor_frame) continue;
      if (auto status = add_transform(t, fixed, frames_); !status) reporter_.fault(status.error());
    }
  }

  struct Waiting {
    SensorCloud cloud;
    std::string frame;
    std::int64_t since_ns;
  };

  void on_cloud(const sensor_msgs::msg::PointCloud2& m) {
    Waiting next{{}, m.header().frame_id(), node_.monotonic_ns()};
    if (auto s = read_cloud(m, std::size_t(config_.max_points), next.cloud); !s) {
      return reporter_.fault(s.error());
    }
    if (m.width() == 0 || m.height() == 0) {  // nothing was seen
      return watch_.saw(next.frame, 0, 0, node_.monotonic_ns());
    }
    take(std::move(next));
  }

  void on_camera(const sensor_msgs::msg::CameraInfo& m) {
    const std::string& frame = m.header().frame_id();
    const auto camera = read_camera_info(m);
    if (!camera) {
      cameras_.erase(frame);
      return reporter_.fault(camera.error());
    }
    if (cameras_.contains(frame) || cameras_.size() < kMostCameras) cameras_[frame] = *camera;
  }

  void on_depth(const sensor_msgs::msg::Image& m) {
    Waiting next{{}, m.header().frame_id(), node_.monotonic_ns()};
    const auto camera = cameras_.find(next.frame);
    if (camera == cameras_.end()) {
      return reporter_.fault(fail(ErrorCode::invalid_input,
                                  fmt::format("no CameraInfo of frame '{}' has come on "
                                              "depth_info_in: its depth images cannot be placed",
                                              next.frame)));
    }
    const auto status = read_depth(m, camera->second, std::size_t(config_.max_points), next.cloud);
    if (!status) return reporter_.fault(status.error());
    take(std::move(next));
  }

  void take(Waiting next) {
    if (waiting_.size() == kMostWaiting) {
      reporter_.fault(fail(ErrorCode::tracking_lost,
                           "clouds come faster than the odometry that places them: the oldest is "
                           "dropped"));
      waiting_.pop_front();
    }
    waiting_.push_back(std::move(next));
    place_waiting();
  }

  // In their order: a cloud whose odometry is still to come holds up those behind it.
  void place_waiting() {
    while (!waiting_.empty()) {
      const Waiting& next = waiting_.front();
      const auto status = place_in_map(next);
      const double waited_s = 1e-9 * double(node_.monotonic_ns() - next.since_ns);
      const bool may_come = !status && status.code() == ErrorCode::tracking_lost &&
                            !odometry_.empty() && waited_s < config_.pose_wait_s &&
                            time_span(next.cloud).first_ns >= odometry_.oldest_ns();
      if (may_come) return;
      if (status) {
        insert(next);
      } else {
        reporter_.fault(status.error());
      }
      waiting_.pop_front();
    }
  }

  // Into placed_ and body_path_.
  Status place_in_map(const Waiting& next) {
    const TimeSpan span = time_span(next.cloud);
    const auto body = odometry_.at(span.last_ns);
    if (!body) return body.error();
    if (next.frame == conversions::kMapFrame) {
      const auto from = odometry_.at(next.cloud.stamp_ns);
      if (!from) return from.error();
      placed_.points_map = next.cloud.points;
      placed_.origins_map.assign(1, from->position);
    } else {
      const auto chain = frames_.chain(next.frame, std::string(conversions::kBodyFrame));
      if (!chain) return chain.error();
      if (auto s = place(next.cloud, *chain, odometry_, placed_); !s) return s;
    }
    odometry_.positions(placed_ns_ == 0 ? span.first_ns : placed_ns_, span.last_ns, body_path_);
    body_path_.push_back(body->position);
    return success();
  }

  void insert(const Waiting& next) {
    const Scan scan{.points_map = placed_.points_map,
                    .origins_map = placed_.origins_map,
                    .max_range_m = config_.max_range_m,
                    .body_path_map = body_path_,
                    .body_radius_m = config_.body_radius_m};
    if (auto status = map_.insert_scan(scan, result_); !status) {
      return reporter_.fault(status.error());
    }
    tell_of_forgotten();
    const std::int64_t returns = std::int64_t(next.cloud.points.size()) - result_.points_left_out;
    watch_.saw(next.frame, std::size_t(returns), std::size_t(result_.points_far),
               node_.monotonic_ns());
    placed_ns_ = time_span(next.cloud).last_ns;
    publish_changes();
  }

  // Of result_, to subscribers and to the journal.
  void publish_changes() {
    output_.add_versions_before(result_.update);
    if (beginning_.journal) {
      beginning_.journal->add(result_.update.to_version,
                              journal_bricks(result_.update, map_.geometry()));
    }
    output_.publish_update(result_.update);
    changed_ = true;
  }

  void tell_of_forgotten() {
    if (forgetting_ || map_.bricks_forgotten() == 0) return;
    forgetting_ = true;  // once: it goes on for the rest of the flight
    reporter_.fault(forgotten_fault(config_));
  }

  void tell_of_sensors() {
    for (const SensorWatch::News& news : watch_.news(node_.monotonic_ns())) {
      if (news.fault) {
        reporter_.fault(*news.fault);
      } else {
        reporter_.ready(news.message);
      }
    }
  }

  void tell_of_journal() {
    if (!beginning_.journal) return;
    if (const auto fault = beginning_.journal->take_fault()) reporter_.fault(*fault);
  }

  Node& node_;
  Config config_;
  Beginning beginning_;  // without its map
  LiveMap map_;
  ScanResult result_;  // its memory is used again
  StageReporter reporter_;
  MapOutput output_;
  PoseBuffer odometry_;
  FrameTree frames_;
  SensorWatch watch_;
  std::map<std::string, Pinhole> cameras_;  // by their frame
  std::deque<Waiting> waiting_;
  PlacedCloud placed_;           // their memory is used again
  std::vector<Vec3> body_path_;  // since the scan before
  std::int64_t placed_ns_ = 0;   // end of the scan before; 0: none
  ErrorCode odometry_code_ = ErrorCode::ok;
  bool changed_ = false;
  unsigned periods_since_change_ = kLastRepeat + 1;  // what was loaded does not change
  bool forgetting_ = false;
};

}  // namespace
}  // namespace goshawk::map_server

GOSHAWK_REGISTER_COMPONENT(goshawk::map_server::MapServerComponent, goshawk::map_server::Config)
