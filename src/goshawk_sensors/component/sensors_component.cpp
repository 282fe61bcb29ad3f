#include <fmt/format.h>

#include <cmath>
#include <deque>
#include <optional>

#include "goshawk/conversions/vehicle.hpp"
#include "goshawk/map_server/map_file.hpp"
#include "goshawk/movers/movers_file.hpp"
#include "goshawk/runtime/component.hpp"
#include "goshawk/sensors/joined_world.hpp"
#include "goshawk/sensors/moving_world.hpp"
#include "goshawk/sensors/voxel_world.hpp"
#include "goshawk/stage/stage_reporter.hpp"
#include "goshawk/worlds/world.hpp"
#include "messages.hpp"

namespace goshawk::sensors {
namespace {

using namespace goshawk::runtime;
using sensor_msgs::msg::CameraInfo;
using sensor_msgs::msg::Image;
using sensor_msgs::msg::PointCloud2;

// How often a world that could not be read is looked for again.
constexpr double kLookAgain_s = 2.0;
// Pauses of odometry that are bridged, and poses that are kept besides those of one scan.
constexpr double kLongestGap_s = 0.5;
constexpr double kKept_s = 2.0;

Result<std::shared_ptr<VoxelWorld>> read_voxels(const Config& config) {
  if (config.world_file.empty()) {
    auto spec = worlds::default_world();
    spec.seed = std::uint64_t(config.world_seed);
    const auto made = worlds::make_world(spec);
    if (!made) return made.error();
    return std::make_shared<VoxelWorld>(made->geometry, made->occupied, config.boundary);
  }
  const auto source = map_server::load_map(config.world_file);
  if (!source) return source.error();
  const auto voxels = map_server::voxelize(*source);
  if (!voxels) return voxels.error();
  return std::make_shared<VoxelWorld>(voxels->geometry, voxels->occupied, config.boundary);
}

/// What moves is read once, at the start: a file that is wrong ends it.
std::shared_ptr<const World> read_moving(const Config& config) {
  if (config.movers_file.empty()) return nullptr;
  auto movers = movers::read_movers(config.movers_file);
  if (!movers) throw StartupFault(movers.error());
  return std::make_shared<MovingWorld>(*std::move(movers),
                                       std::llround(1e9 * config.movers_start_s));
}

Sensor make_sensor(const Config& config) {
  auto sensor = Sensor::create(config.sensor);
  if (!sensor) throw StartupFault(sensor.error());
  if (config.frame.empty() || config.frame.front() == '/') {
    throw StartupFault(
        fail(ErrorCode::invalid_parameter,
             "frame is '" + config.frame + "': a frame needs a name, without a leading slash"));
  }
  if (auto status = check_missing(config); !status) throw StartupFault(status.error());
  return *std::move(sensor);
}

/// odom (the truth) -> points, or depth/image_rect_raw, depth/camera_info and points; /tf_static
///
/// Time is that of odometry: what was measured is published with the first odometry whose stamp is
/// latency_s after the end of the scan. So the same odometry gives the same messages.
class SensorsComponent : public Component {
 public:
  explicit SensorsComponent(Node& node)
      : node_(node),
        config_(node.parameters<Config>([this](const Config& c) { return reconfigure(c); })),
        sensor_(make_sensor(config_)),
        form_(CloudForm::of(config_)),
        moving_(read_moving(config_)),
        track_(kLongestGap_s, kKept_s + 1.0 / config_.sensor.pattern.rate_hz),
        reporter_(node, StageRole::other, std::string(to_word(config_.sensor.pattern.pattern))),
        transforms_(node.advertise<tf2_msgs::msg::TFMessage>("/tf_static", Qos::latched())) {
    const bool camera = config_.sensor.pattern.pattern == Pattern::depth_camera;
    if (camera) {
      image_ = node.advertise<Image>("depth/image_rect_raw", Qos::best_effort(2));
      info_ = node.advertise<CameraInfo>("depth/camera_info", Qos::best_effort(2));
    }
    if (!camera || config_.camera_cloud) {
      cloud_ = node.advertise<PointCloud2>("points", Qos::best_effort(2));
    }
    node.subscribe<nav_msgs::msg::Odometry>(
        "odom", Qos::best_effort(10),
        [this](const nav_msgs::msg::Odometry& m, const MessageInfo&) { on_odometry(m); },
        Writers::one("odom"));
    node.every(kLookAgain_s, [this] {
      if (!world_) look_for_world();
    });
    reporter_.send(transforms_, static_transforms(config_, node.now_ns()));
    look_for_world();
  }

 private:
  struct Waiting {
    std::int64_t due_ns;
    std::optional<PointCloud2> cloud;
    std::optional<Image> image;
  };

  Status reconfigure(const Config& config) {
    if (auto status = check_change(config_, config); !status) return status;
    config_ = config;
    return success();
  }

  void look_for_world() {
    const auto voxels = read_voxels(config_);
    if (!voxels) {
      return reporter_.fault(fail(
          voxels.code(), voxels.error().message + "; nothing is measured until it can be read"));
    }
    world_ = *voxels;
    if (moving_) world_ = std::make_shared<JoinedWorld>(std::vector{world_, moving_});
    const GridGeometry& g = (*voxels)->geometry();
    reporter_.ready(
        fmt::format("{} rays a scan, {:g} scans a second, in a world of {} voxels of "
                    "{:.3g} m",
                    sensor_.pattern().firings(), config_.sensor.pattern.rate_hz, to_text(g.size),
                    g.resolution_m));
  }

  void on_odometry(const nav_msgs::msg::Odometry& m) {
    const auto state = conversions::from_msg(m);
    if (!state) return reporter_.complain(state.error());
    const std::int64_t stamp_ns = conversions::to_ns(m.header().stamp());
    if (!track_.empty() && stamp_ns < track_.last_ns()) waiting_.clear();  // time began anew
    if (auto status = track_.add(stamp_ns, {state->position_map, state->q_map_base}); !status) {
      return reporter_.complain(status.error());
    }
    if (!world_) return;
    const auto status = sensor_.advance(*world_, track_, [this](const Scan& scan) { take(scan); });
    if (!status) reporter_.complain(status.error());
    while (!waiting_.empty() && waiting_.front().due_ns <= stamp_ns) {
      publish(waiting_.front());
      waiting_.pop_front();
    }
  }

  void take(const Scan& seen) {
    if (config_.covered) {
      dark_ = seen;
      for (Return& r : dark_.returns) r = {.offset_ns = r.offset_ns, .ring = r.ring};
    }
    const Scan& scan = config_.covered ? dark_ : seen;
    Waiting& waiting = waiting_.emplace_back();
    waiting.due_ns = scan.end_ns + std::llround(1e9 * config_.sensor.latency_s);
    if (image_) fill_msg(scan, config_, waiting.image.emplace());
    if (cloud_) fill_msg(scan, form_, track_, waiting.cloud.emplace());
  }

  void publish(const Waiting& waiting) {
    if (waiting.image) {
      reporter_.send(*image_, *waiting.image);
      CameraInfo info = camera_info(config_.sensor.pattern);
      info.header(waiting.image->header());
      reporter_.send(*info_, info);
    }
    if (waiting.cloud) reporter_.send(*cloud_, *waiting.cloud);
  }

  Node& node_;
  Config config_;
  Sensor sensor_;
  CloudForm form_;
  std::shared_ptr<const World> moving_;
  PoseTrack track_;  // longer than a scan
  stage::StageReporter reporter_;
  Publisher<tf2_msgs::msg::TFMessage> transforms_;
  std::optional<Publisher<PointCloud2>> cloud_;
  std::optional<Publisher<Image>> image_;
  std::optional<Publisher<CameraInfo>> info_;
  std::shared_ptr<const World> world_;
  std::deque<Waiting> waiting_;
  Scan dark_;  // of a covered lens
};

}  // namespace
}  // namespace goshawk::sensors

GOSHAWK_REGISTER_COMPONENT(goshawk::sensors::SensorsComponent, goshawk::sensors::Config)
