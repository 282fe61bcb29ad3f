#include "stage/feeder.hpp"

#include <cstdlib>
#include <map>
#include <optional>
#include <thread>

#include "common/child.hpp"
#include "goshawk/conversions/plan.hpp"
#include "goshawk/conversions/status.hpp"
#include "goshawk/conversions/vehicle.hpp"
#include "goshawk/recording_tools/messages.hpp"
#include "goshawk/runtime/component.hpp"
#include "goshawk/runtime/node.hpp"
#include "nav_msgs.h"
#include "sensor_msgs.h"

namespace goshawk::bench {
namespace {

using namespace goshawk::runtime;
namespace msg = goshawk_msgs::msg;

constexpr double kMeet_s = 20.0, kSettle_s = 1.0;
constexpr int kWarm = 10;
constexpr const char* kCycloneOnLoopback =
    "<CycloneDDS><Domain><General><Interfaces><NetworkInterface name='lo'/></Interfaces>"
    "<AllowMulticast>false</AllowMulticast></General><Discovery><Peers><Peer address='127.0.0.1'/>"
    "</Peers><ParticipantIndex>auto</ParticipantIndex></Discovery></Domain></CycloneDDS>";

// How inputs are told from one another in the answers: requests by their ids, odometry by its
// stamp; clouds are answered in their order.
msg::PlanRequest& request_of(msg::PlanRequest& m) {
  return m;
}
template <typename Message>
requires requires(Message& m) {
  m.request();
}
msg::PlanRequest& request_of(Message& m) {
  return m.request();
}
using Key = std::uint64_t;
constexpr Key kOldest = 0;

/// Makes a recorded input a new one. @return its key
template <typename Input>
Key renew(Input& m, std::uint64_t number, std::int64_t now_ns) {
  m.header().stamp(conversions::to_stamp(now_ns));
  if constexpr (std::is_same_v<Input, nav_msgs::msg::Odometry>) return Key(now_ns);
  if constexpr (requires { request_of(m); }) {
    request_of(m).id(number);
    request_of(m).header().stamp(conversions::to_stamp(now_ns));
  }
  return number;
}

template <typename Output>
Key key_of(const Output& m) {
  if constexpr (requires { m.request(); }) return m.request().id();
  if constexpr (std::is_same_v<Output, msg::TrackingState>) {
    return Key(conversions::to_ns(m.header().stamp()));
  }
  return kOldest;
}

// The control loop answers without a second try.
template <typename Output>
Qos answered_by() {
  return std::is_same_v<Output, msg::TrackingState> ? Qos::best_effort(100)
                                                    : Qos::reliable_last(100);
}

/// [ns] in the core, or nothing if the answer does not tell
template <typename Output>
std::optional<std::int64_t> compute_ns_of(const Output& m) {
  if constexpr (requires { m.compute_ns(); }) return m.compute_ns();
  return {};
}

// Where the world is to come from: a box of unknown space, which clouds fill.
RosArgs arguments_of(const std::string& stage) {
  RosArgs args;
  args.log_level = "error";
  if (stage == "map_server") args.overrides.push_back({stage, "use_box", "true"});
  return args;
}

/// What is measured: a program, or our component with a node and a thread as in the container.
class Stage {
 public:
  static Result<std::unique_ptr<Stage>> start(const FeedOptions& options, Context& context,
                                              const std::string& command) {
    auto stage = std::unique_ptr<Stage>(new Stage);
    if (!command.empty()) {
      // A program with Cyclone DDS looks for us where we are.
      setenv("CYCLONEDDS_URI", kCycloneOnLoopback, 0);
      stage->child_.emplace(std::vector<std::string>{"/bin/sh", "-c", "exec " + command},
                            options.domain);
      return stage;
    }
    const auto component = load_component(options.stage);
    if (!component) return component.error();
    stage->node_ = std::make_unique<Node>(context, options.stage, arguments_of(options.stage));
    stage->component_ = (*component)->create(*stage->node_);
    stage->thread_ = std::thread([node = stage->node_.get()] { node->spin(); });
    return stage;
  }
  ~Stage() {
    if (node_ != nullptr) node_->stop();
    if (thread_.joinable()) thread_.join();
    component_.reset();
  }
  /// @return whether the program has ended by itself
  bool ended() { return child_ && child_->ended(); }

 private:
  Stage() = default;
  std::optional<Child> child_;
  std::unique_ptr<Node> node_;
  std::unique_ptr<Component> component_;
  std::thread thread_;
};

/// Sends the requests and collects the answers.
template <typename Input, typename Output>
class Feeder {
 public:
  Feeder(const FeedOptions& options, Context& context, const std::string& in,
         const std::string& out)
      : options_(options),
        node_(context, "goshawk_bench_stage"),
        maps_(node_.advertise<msg::VoxelGrid>("map/voxels", Qos::latched())),
        inputs_(node_.advertise<Input>(in, Qos::reliable_last())) {
    node_.subscribe<Output>(
        out, answered_by<Output>(),
        [this](const Output& m, const MessageInfo& info) { on_answer(m, info.received_ns); });
    node_.subscribe<msg::StageReport>("stage_report", Qos::latched(100),
                                      [this](const msg::StageReport& m, const auto&) {
                                        const auto role = conversions::stage_role_of(m.stage());
                                        if (m.code() == "ok" || role != role_) return;
                                        const auto asked = find(m.request_id());
                                        if (asked == open_.end()) return;
                                        open_.erase(asked);
                                        ++samples_.refused;
                                      });
    if (options.stage == "map_server") {
      vehicle_ = node_.advertise<nav_msgs::msg::Odometry>("odom", Qos::best_effort());
    }
  }

  /// @return whether somebody reads the inputs
  bool meet(Stage& stage) {
    wait(kMeet_s, [&] { return inputs_.matched() > 0 || stage.ended(); });
    return inputs_.matched() > 0;
  }

  /// @param map or nullptr
  Result<FeedSamples> feed(const std::vector<Input>& inputs, const msg::VoxelGrid* map) {
    if (map != nullptr) (void)maps_.publish(*map);
    wait(kSettle_s, [] { return false; });
    if (vehicle_) place_vehicle();
    std::int64_t begin_ns = 0;
    for (int k = 0; k < options_.count + kWarm; ++k) {
      if (k == kWarm) {  // what came before did not count
        samples_ = {};
        open_.clear();
        begin_ns = node_.now_ns();
      }
      if (auto status = send(inputs[std::size_t(k) % inputs.size()]); !status) {
        return status.error();
      }
      if (options_.rate_hz <= 0.0 || k < kWarm) {
        wait(options_.timeout_s, [&] { return open_.empty(); });
      } else {
        const double due_s = double(k - kWarm + 1) / options_.rate_hz;
        wait(due_s - 1e-9 * double(node_.now_ns() - begin_ns), [] { return false; });
      }
      samples_.elapsed_s = 1e-9 * double(node_.now_ns() - begin_ns);
    }
    wait(options_.timeout_s, [&] { return open_.empty(); });
    samples_.lost = int(open_.size());
    return samples_;
  }

 private:
  template <typename Done>
  bool wait(double seconds, const Done& done) {
    const auto end_ns = node_.now_ns() + std::int64_t(1e9 * seconds);
    for (auto left_ns = end_ns - node_.now_ns(); !done() && left_ns > 0;
         left_ns = end_ns - node_.now_ns()) {
      node_.spin_some(std::min(0.02, 1e-9 * double(left_ns)));
    }
    return done();
  }

  Status send(Input input) {
    const std::int64_t now_ns = node_.now_ns();
    if (vehicle_) publish_vehicle(now_ns);  // a cloud is placed by the pose at its stamp
    open_[renew(input, ++number_, now_ns)] = now_ns;
    ++samples_.sent;
    return inputs_.publish(input);
  }

  void publish_vehicle(std::int64_t stamp_ns) {
    nav_msgs::msg::Odometry m;
    conversions::fill_msg(RigidBodyState{}, m);
    m.header(conversions::make_header(stamp_ns));
    (void)vehicle_->publish(m);
  }

  // Best effort: some of them come.
  void place_vehicle() {
    for (int k = 0; k < 10; ++k) {
      publish_vehicle(node_.now_ns());
      wait(0.02, [] { return false; });
    }
  }

  auto find(Key key) { return key == kOldest ? open_.begin() : open_.find(key); }

  void on_answer(const Output& m, std::int64_t received_ns) {
    const auto asked = find(key_of(m));
    if (asked == open_.end()) return;
    const double total_us = 1e-3 * double(received_ns - asked->second);
    samples_.total_us.push_back(total_us);
    if (const auto compute_ns = compute_ns_of(m)) {
      samples_.compute_us.push_back(1e-3 * double(*compute_ns));
      samples_.wire_us.push_back(total_us - samples_.compute_us.back());
    }
    open_.erase(asked);
  }

  const FeedOptions& options_;
  const std::optional<StageRole> role_ = stage_role_of(options_.stage);
  Node node_;
  Publisher<msg::VoxelGrid> maps_;
  Publisher<Input> inputs_;
  FeedSamples samples_;
  std::map<Key, std::int64_t> open_;  // what is not answered, and when it was sent
  std::uint64_t number_ = 0;
  std::optional<Publisher<nav_msgs::msg::Odometry>> vehicle_;  // of who needs its place
};

template <typename Input, typename Output>
Result<FeedSamples> feed(const FeedOptions& options, const std::string& command,
                         recording::Reader& reader, const std::string& in, const std::string& out) {
  const auto inputs = recording::messages_of<Input>(reader, in);
  if (!inputs) return inputs.error();
  // Who reads no map gets along without.
  const auto maps = recording::messages_of<msg::VoxelGrid>(reader, "map/voxels");
  ContextOptions context_options;
  context_options.domain = options.domain;
  auto context = Context::create(context_options);
  if (!context) return context.error();
  const auto stage = Stage::start(options, **context, command);
  if (!stage) return stage.error();
  Feeder<Input, Output> feeder(options, **context, in, out);
  if (!feeder.meet(**stage)) {
    return fail(ErrorCode::stage_silent,
                "'" + command + "' " +
                    ((*stage)->ended() ? "ended by itself"
                                       : "does not read " + in + " in domain " +
                                             std::to_string(options.domain) + " on loopback"));
  }
  return feeder.feed(*inputs, maps ? &maps->back() : nullptr);
}

}  // namespace

std::vector<std::string> fed_stages() {
  return {"path_search", "corridor_builder", "trajectory_optimizer", "tracker", "map_server"};
}

Result<FeedSamples> feed(const FeedOptions& o, const std::string& command,
                         recording::Reader& reader) {
  if (o.stage == "path_search") {
    return feed<msg::PlanRequest, msg::Path>(o, command, reader, "plan_request", "path");
  }
  if (o.stage == "corridor_builder") {
    return feed<msg::Path, msg::Corridor>(o, command, reader, "path", "corridor");
  }
  if (o.stage == "tracker") {
    return feed<nav_msgs::msg::Odometry, msg::TrackingState>(o, command, reader, "odom",
                                                             "tracking_state");
  }
  if (o.stage == "map_server") {
    return feed<sensor_msgs::msg::PointCloud2, msg::VoxelGridUpdate>(o, command, reader, "cloud_in",
                                                                     "map/voxels/updates");
  }
  return feed<msg::Corridor, msg::BezierTrajectory>(o, command, reader, "corridor", "trajectory");
}

}  // namespace goshawk::bench
