#include "goshawk/conversions/vehicle.hpp"
#include "goshawk/runtime/component.hpp"
#include "goshawk/stage/stage_reporter.hpp"
#include "goshawk/viewer_bridge/octomap_voxels.hpp"
#include "markers.hpp"
#include "octomap_msgs.h"

namespace goshawk::viewer_bridge {

struct VisualizerConfig {
  int most_cubes = 200000;
  double track_step_m = 0.02;
};

template <typename Self, typename Visitor>
requires std::same_as<std::remove_const_t<Self>, VisualizerConfig>
void describe(Self& c, Visitor&& visit) {
  visit("most_cubes", c.most_cubes, "", "voxels drawn at most; of more, every n-th is left",
        AtRunTime{Range{1, 10000000}});
  visit("track_step_m", c.track_step_m, "m", "between points of the flown track",
        AtRunTime{Range{0.001, 10.0}});
}

namespace {

using namespace goshawk::runtime;
using namespace goshawk::stage;
namespace msg = goshawk_msgs::msg;
using visualization_msgs::msg::MarkerArray;

constexpr std::size_t kMostTrack = 20000;  // points; the oldest half goes beyond

/// What stages say, as pictures that any ROS 2 viewer draws: view/obstacles, view/plan, view/flown.
class VisualizerComponent : public Component {
 public:
  explicit VisualizerComponent(Node& node)
      : node_(node),
        config_(node.parameters<VisualizerConfig>([this](const VisualizerConfig& c) {
          config_ = c;  // of the pictures to come
          return success();
        })),
        reporter_(node, StageRole::viewer, "markers"),
        obstacles_(node.advertise<MarkerArray>("view/obstacles", Qos::latched())),
        plan_(node.advertise<MarkerArray>("view/plan", Qos::latched())),
        flown_(node.advertise<MarkerArray>("view/flown", Qos::latched())) {
    node.subscribe<octomap_msgs::msg::Octomap>(
        "octomap_binary", Qos::latched(),
        [this](const octomap_msgs::msg::Octomap& m, const MessageInfo&) { on_map(m); });
    node.subscribe<msg::Path>("path", Qos::reliable_last(),
                              [this](const msg::Path& m, const MessageInfo&) { path_ = m; });
    node.subscribe<msg::CommittedTrajectory>(
        "committed_trajectory", Qos::latched(),
        [this](const msg::CommittedTrajectory& m, const MessageInfo&) { on_trajectory(m); });
    node.subscribe<nav_msgs::msg::Odometry>(
        "odom", Qos::best_effort(),
        [this](const nav_msgs::msg::Odometry& m, const MessageInfo&) { on_odometry(m); });
    node.every(0.2, [this] { publish_track(); });
    reporter_.ready("draws on view/obstacles, view/plan and view/flown");
  }

 private:
  void on_map(const octomap_msgs::msg::Octomap& m) {
    const auto& data = m.data();
    const auto grid = octomap_voxels(
        {reinterpret_cast<const std::uint8_t*>(data.data()), data.size()}, m.resolution());
    if (!grid) return reporter_.fault(grid.error());
    MarkerArray array;
    array.markers().push_back(voxel_marker(*grid, config_.most_cubes, node_.now_ns()));
    reporter_.send(obstacles_, array);
  }

  void on_trajectory(const msg::CommittedTrajectory& m) {
    const auto committed = conversions::from_msg(m);
    if (!committed) return reporter_.fault(committed.error());
    const std::int64_t now_ns = node_.now_ns();
    MarkerArray array;
    if (path_.request().id() == committed->id()) {
      array.markers().push_back(line_marker("path as searched", conversions::from_msg(path_.raw()),
                                            0.02, {0.79, 0.64, 1.0}, now_ns));
      array.markers().push_back(line_marker("pruned path", conversions::from_msg(path_.waypoints()),
                                            0.025, {0.95, 0.89, 0.30}, now_ns));
    }
    for (auto& marker : corridor_markers(committed->flown_polytopes(), now_ns)) {
      array.markers().push_back(std::move(marker));
    }
    array.markers().push_back(
        trajectory_marker(committed->flown(), committed->nominal().limits().v_max_m_s, now_ns));
    reporter_.send(plan_, array);
  }

  void on_odometry(const nav_msgs::msg::Odometry& m) {
    const auto state = conversions::from_msg(m);
    if (!state) return;  // the tracker says what is wrong with it
    if (!track_.empty() && (track_.back() - state->position_map).norm() < config_.track_step_m) {
      return;
    }
    if (track_.size() >= kMostTrack) track_.erase(track_.begin(), track_.begin() + kMostTrack / 2);
    track_.push_back(state->position_map);
    track_is_new_ = true;
  }

  void publish_track() {
    if (!track_is_new_ || track_.size() < 2) return;
    track_is_new_ = false;
    MarkerArray array;
    array.markers().push_back(
        line_marker("flown track", track_, 0.025, {1.0, 1.0, 1.0}, node_.now_ns()));
    reporter_.send(flown_, array);
  }

  Node& node_;
  VisualizerConfig config_;
  StageReporter reporter_;
  Publisher<MarkerArray> obstacles_;
  Publisher<MarkerArray> plan_;
  Publisher<MarkerArray> flown_;
  msg::Path path_;
  std::vector<Vec3> track_;
  bool track_is_new_ = false;
};

}  // namespace
}  // namespace goshawk::viewer_bridge

GOSHAWK_REGISTER_COMPONENT(goshawk::viewer_bridge::VisualizerComponent,
                           goshawk::viewer_bridge::VisualizerConfig)
