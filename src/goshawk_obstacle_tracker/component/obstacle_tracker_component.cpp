#include <fmt/format.h>

#include <optional>

#include "config.hpp"
#include "goshawk/conversions/moving_boxes.hpp"
#include "goshawk/conversions/vehicle.hpp"
#include "goshawk/map_server/frame_tree.hpp"
#include "goshawk/map_server/placement.hpp"
#include "goshawk/map_server_messages/cloud.hpp"
#include "goshawk/map_server_messages/transform.hpp"
#include "goshawk/runtime/component.hpp"
#include "goshawk/stage/intake.hpp"
#include "messages.hpp"
#include "tf2_msgs.h"

namespace goshawk::obstacle_tracker {
namespace {

using namespace goshawk::runtime;
using namespace goshawk::stage;
using map_server::FrameTree;
using map_server::PlacedCloud;
using map_server::PoseBuffer;
using map_server::SensorCloud;
namespace msg = goshawk_msgs::msg;

constexpr double kPosesKept_s = 5.0;
constexpr double kLookAgain_s = 0.02;  // at a cloud that waits for odometry
constexpr double kReport_s = 1.0;

ObstacleTracker make_tracker(const ComponentConfig& config) {
  auto tracker = ObstacleTracker::create(config.tracker);
  if (!tracker) throw StartupFault(tracker.error());
  return *std::move(tracker);
}

/// cloud_in, odom, /tf and /tf_static, or movers -> obstacles (predictions), tracks (estimates)
class ObstacleTrackerComponent : public Component {
 public:
  explicit ObstacleTrackerComponent(Node& node)
      : node_(node),
        config_(node.parameters<ComponentConfig>()),
        tracker_(make_tracker(config_)),
        reporter_(node, StageRole::obstacle_tracker, std::string(to_word(config_.source))),
        obstacles_(node.advertise<msg::PredictedObstacles>("obstacles", Qos::reliable_last(1))),
        tracks_(node.advertise<msg::MovingBoxes>("tracks", Qos::best_effort(2))),
        odometry_("odometry", kPosesKept_s, config_.pose_max_gap_s),
        frames_(kPosesKept_s, config_.pose_max_gap_s) {
    if (config_.source == Source::clouds) {
      subscribe_to_clouds();
    } else {
      node.subscribe<msg::MovingBoxes>(
          "movers", Qos::best_effort(2),
          [this](const msg::MovingBoxes& m, const MessageInfo&) { on_movers(m); },
          Writers::one("movers"));
    }
    node.every(kReport_s, [this] { report(); });
    reporter_.ready(fmt::format("tracks what moves within {:g} m, from {}", config_.tracker.range_m,
                                to_word(config_.source)));
  }

 private:
  struct Waiting {
    SensorCloud cloud;
    std::string frame;
    std::int64_t since_ns = 0;
    std::int64_t wire_ns = 0;
  };

  void subscribe_to_clouds() {
    node_.subscribe<sensor_msgs::msg::PointCloud2>(
        "cloud_in", Qos::best_effort(1),
        [this](const sensor_msgs::msg::PointCloud2& m, const MessageInfo& i) { on_cloud(m, i); });
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
    node_.every(kLookAgain_s, [this] { look_at_waiting(); });
  }

  void on_odometry(const nav_msgs::msg::Odometry& m) {
    const auto state = conversions::from_msg(m);
    if (!state) return reporter_.complain(state.error());
    const auto status = odometry_.add(conversions::to_ns(m.header().stamp()),
                                      {state->position_map, state->q_map_base});
    if (!status) {
      if (status.code() == ErrorCode::clock_set) tracker_.reset();
      return reporter_.complain(status.error());
    }
    look_at_waiting();
  }

  void on_frames(const tf2_msgs::msg::TFMessage& m, bool fixed) {
    for (const auto& t : m.transforms()) {
      if (t.child_frame_id() == conversions::kBodyFrame) continue;  // comes as odometry
      const auto status = map_server::add_transform(t, fixed, frames_);
      if (!status) reporter_.complain(status.error());
    }
  }

  // A newer cloud takes the place of one that still waits.
  void on_cloud(const sensor_msgs::msg::PointCloud2& m, const MessageInfo& info) {
    Waiting next{{}, m.header().frame_id(), node_.monotonic_ns(), wire_time_ns(m.header(), info)};
    if (auto s = map_server::read_cloud(m, std::size_t(config_.max_points), next.cloud); !s) {
      return reporter_.complain(s.error());
    }
    waiting_ = std::move(next);
    look_at_waiting();
  }

  void look_at_waiting() {
    if (!waiting_) return;
    const auto status = place(*waiting_);
    const double waited_s = 1e-9 * double(node_.monotonic_ns() - waiting_->since_ns);
    const bool may_come =
        !status && status.code() == ErrorCode::tracking_lost && waited_s < config_.pose_wait_s;
    if (may_come) return;
    if (status) {
      track(*waiting_);
    } else {
      reporter_.complain(status.error());
    }
    waiting_.reset();
  }

  // Into placed_.
  Status place(const Waiting& next) {
    if (next.frame == conversions::kMapFrame) {
      const auto from = odometry_.at(next.cloud.stamp_ns);
      if (!from) return from.error();
      placed_.points_map = next.cloud.points;
      placed_.origins_map.assign(1, from->position);
      return success();
    }
    const auto chain = frames_.chain(next.frame, std::string(conversions::kBodyFrame));
    if (!chain) return chain.error();
    return map_server::place(next.cloud, *chain, odometry_, placed_);
  }

  void track(const Waiting& next) {
    const auto [status, compute_ns] = timed([&] {
      return tracker_.add(
          {next.cloud.stamp_ns, placed_.points_map, placed_.origins_map, next.cloud.offsets_ns});
    });
    if (!status) return reporter_.complain(status.error());
    timing_ = {.wire_ns = next.wire_ns, .compute_ns = compute_ns};
    publish(tracker_.obstacles(), tracker_.time_ns());
  }

  void on_movers(const msg::MovingBoxes& m) {
    const auto boxes = conversions::from_msg(m);
    if (!boxes) return reporter_.complain(boxes.error());
    publish(bounded(*boxes, config_.tracker), conversions::to_ns(m.header().stamp()));
  }

  void publish(std::span<const TrackedObstacle> found, std::int64_t stamp_ns) {
    predicted_.header(conversions::make_header(stamp_ns));
    predicted_.version(++version_);
    fill_msg(found, predicted_);
    reporter_.send(obstacles_, predicted_);
    boxes_.clear();
    for (const TrackedObstacle& o : found) boxes_.push_back(o.box);
    estimates_.header(predicted_.header());
    conversions::fill_msg(boxes_, estimates_);
    reporter_.send(tracks_, estimates_);
  }

  // Once a second, if something came: its request is the version of `obstacles`.
  void report() {
    if (version_ == reported_) return;
    reporter_.answered(version_, timing_, {{"obstacles", double(predicted_.obstacles().size())}});
    reported_ = version_;
  }

  Node& node_;
  ComponentConfig config_;
  ObstacleTracker tracker_;
  StageReporter reporter_;
  Publisher<msg::PredictedObstacles> obstacles_;
  Publisher<msg::MovingBoxes> tracks_;
  PoseBuffer odometry_;
  FrameTree frames_;
  std::optional<Waiting> waiting_;
  PlacedCloud placed_;  // its memory is used again
  msg::PredictedObstacles predicted_;
  msg::MovingBoxes estimates_;
  std::vector<MovingBox> boxes_;
  Timing timing_;
  std::uint64_t version_ = 0, reported_ = 0;
};

}  // namespace
}  // namespace goshawk::obstacle_tracker

GOSHAWK_REGISTER_COMPONENT(goshawk::obstacle_tracker::ObstacleTrackerComponent,
                           goshawk::obstacle_tracker::ComponentConfig)
