#include <optional>

#include "goshawk/conversions/vehicle.hpp"
#include "goshawk/runtime/component.hpp"
#include "goshawk/stage/stage_reporter.hpp"
#include "markers.hpp"
#include "octomap_msgs.h"

namespace goshawk::visualization {

struct Config {
  int most_cubes = 200000;
  double track_step_m = 0.02;
};

template <typename Self, typename Visitor>
requires std::same_as<std::remove_const_t<Self>, Config>
void describe(Self& c, Visitor&& visit) {
  visit("most_cubes", c.most_cubes, "", "largest number of voxels to draw; of more, every n-th",
        AtRunTime{Range{1, 10000000}});
  visit("track_step_m", c.track_step_m, "m", "distance between points of the flown track",
        AtRunTime{Range{0.001, 10.0}});
}

namespace {

using namespace goshawk::runtime;
using namespace goshawk::stage;
namespace msg = goshawk_msgs::msg;
using octomap_msgs::msg::Octomap;
using visualization_msgs::msg::MarkerArray;

constexpr double kPeriod_s = 0.2;
constexpr std::size_t kMostTrack = 20000;  // points; then the older half is dropped
constexpr std::int64_t kMostVoxels = 300'000'000;

/// octomap_binary, path, committed_trajectory, odom -> view/obstacles, view/plan, view/flown,
/// path_line, markers: pictures for any ROS 2 viewer. Maps and tracks are drawn only while
/// somebody reads them.
class VisualizerComponent : public Component {
 public:
  explicit VisualizerComponent(Node& node)
      : node_(node),
        config_(node.parameters<Config>([this](const Config& c) {
          config_ = c;
          return success();
        })),
        reporter_(node, StageRole::viewer, "markers"),
        obstacles_(node.advertise<MarkerArray>("view/obstacles", Qos::latched())),
        plan_(node.advertise<MarkerArray>("view/plan", Qos::latched())),
        flown_(node.advertise<MarkerArray>("view/flown", Qos::latched())),
        path_line_(node.advertise<nav_msgs::msg::Path>("path_line", Qos::latched())),
        corridor_(node.advertise<MarkerArray>("markers", Qos::latched())) {
    node.subscribe<Octomap>("octomap_binary", Qos::latched(),
                            [this](const Octomap& m, const MessageInfo&) { new_map_ = m; });
    node.subscribe<msg::Path>("path", Qos::reliable_last(),
                              [this](const msg::Path& m, const MessageInfo&) { path_ = m; });
    node.subscribe<msg::CommittedTrajectory>(
        "committed_trajectory", Qos::latched(),
        [this](const msg::CommittedTrajectory& m, const MessageInfo&) { draw_plan(m); });
    node.subscribe<nav_msgs::msg::Odometry>(
        "odom", Qos::best_effort(),
        [this](const nav_msgs::msg::Odometry& m, const MessageInfo&) { on_odometry(m); });
    node.every(kPeriod_s, [this] {
      draw_map();
      draw_track();
    });
    reporter_.ready("draws on view/obstacles, view/plan, view/flown, path_line and markers");
  }

 private:
  template <typename... Markers>
  void send_markers(const Publisher<MarkerArray>& publisher, Markers&&... markers) {
    MarkerArray array;
    (array.markers().push_back(std::forward<Markers>(markers)), ...);
    reporter_.send(publisher, array);
  }

  void draw_map() {
    if (!new_map_ || obstacles_.matched() == 0) return;
    const auto map = std::exchange(new_map_, {});
    const std::string_view payload(reinterpret_cast<const char*>(map->data().data()),
                                   map->data().size());
    const auto tree = map_server::read_binary_payload(payload, map->resolution());
    if (!tree) return reporter_.fault(tree.error());
    const auto voxels = map_server::voxelize(**tree, {.box = {}, .max_voxels = kMostVoxels});
    if (!voxels) return reporter_.fault(voxels.error());
    send_markers(obstacles_, voxel_marker(*voxels, config_.most_cubes, node_.now_ns()));
  }

  void draw_plan(const msg::CommittedTrajectory& m) {
    const auto committed = conversions::from_msg(m);
    if (!committed) return reporter_.fault(committed.error());
    const Trajectory& trajectory = committed->flown();
    const auto polytopes = committed->flown_polytopes();
    const std::int64_t start_ns = committed->start_time_ns();
    reporter_.send(path_line_, path_line(trajectory, 0.05, start_ns));
    send_markers(corridor_, edge_marker("corridor", polytopes, 0.02, start_ns));

    const std::int64_t now_ns = node_.now_ns();
    MarkerArray array;
    if (path_.request().id() == committed->id()) {
      array.markers().push_back(line_marker("path as searched", conversions::from_msg(path_.raw()),
                                            0.02, {0.79, 0.64, 1.0}, now_ns));
      array.markers().push_back(line_marker("pruned path", conversions::from_msg(path_.waypoints()),
                                            0.025, {0.95, 0.89, 0.30}, now_ns));
    }
    array.markers().push_back(face_marker(polytopes, now_ns));
    array.markers().push_back(edge_marker("corridor edges", polytopes, 0.015, now_ns));
    array.markers().push_back(
        trajectory_marker(trajectory, committed->nominal().limits().v_max_m_s, now_ns));
    reporter_.send(plan_, array);
  }

  void on_odometry(const nav_msgs::msg::Odometry& m) {
    const auto state = conversions::from_msg(m);
    if (!state) return;  // the tracker reports bad odometry
    if (!track_.empty() && (track_.back() - state->position_map).norm() < config_.track_step_m) {
      return;
    }
    if (track_.size() >= kMostTrack) track_.erase(track_.begin(), track_.begin() + kMostTrack / 2);
    track_.push_back(state->position_map);
    track_is_new_ = true;
  }

  void draw_track() {
    if (!track_is_new_ || track_.size() < 2 || flown_.matched() == 0) return;
    track_is_new_ = false;
    send_markers(flown_,
                 line_marker("flown track", track_, 0.025, {1.0, 1.0, 1.0}, node_.now_ns()));
  }

  Node& node_;
  Config config_;
  StageReporter reporter_;
  Publisher<MarkerArray> obstacles_;
  Publisher<MarkerArray> plan_;
  Publisher<MarkerArray> flown_;
  Publisher<nav_msgs::msg::Path> path_line_;
  Publisher<MarkerArray> corridor_;
  std::optional<Octomap> new_map_;  // not drawn yet
  msg::Path path_;
  std::vector<Vec3> track_;
  bool track_is_new_ = false;
};

}  // namespace
}  // namespace goshawk::visualization

GOSHAWK_REGISTER_COMPONENT(goshawk::visualization::VisualizerComponent,
                           goshawk::visualization::Config)
