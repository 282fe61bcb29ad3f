// goshawk_impostor LIE [--to x,y,z] [--rate PER_S]: a member of the domain that speaks as a stage.
// It lies until SIGINT or SIGTERM, then says in a JSON object how many messages it has sent.

#include <fmt/format.h>
#include <signal.h>

#include <array>
#include <atomic>
#include <charconv>
#include <cstdio>
#include <functional>
#include <map>
#include <optional>
#include <stdexcept>
#include <string>

#include "goshawk/conversions/plan.hpp"
#include "goshawk/conversions/status.hpp"
#include "goshawk/conversions/vehicle.hpp"
#include "goshawk/runtime/node.hpp"
#include "lies.hpp"

namespace {

using namespace goshawk;
using namespace goshawk::hostile;
using runtime::MessageInfo;
using runtime::Node;
using runtime::Qos;
namespace msg = goshawk_msgs::msg;

struct Options {
  std::string lie;
  Vec3 to_map = Vec3(3.0, 8.0, 2.0);  // [m] where the vehicle is to be flown, by a straight line
  double rate = 2.0;                  // [1/s] of what does not answer
};

std::atomic<bool> g_stop = false;

class Impostor {
 public:
  Impostor(Node& node, const Options& options) : node_(node), options_(options) {}

  /// @return false if there is no such lie
  bool begin() {
    const auto lie = lies().find(options_.lie);
    if (lie == lies().end()) return false;
    (this->*lie->second)();
    return true;
  }
  long sent() const { return sent_; }

 private:
  using Begin = void (Impostor::*)();
  static const std::map<std::string, Begin>& lies() {
    static const std::map<std::string, Begin> all{
        {"commit", &Impostor::commits},
        {"commit_of_no_map", &Impostor::commits_of_no_map},
        {"trajectory", &Impostor::trajectories},
        {"bad_trajectory", &Impostor::bad_trajectories},
        {"corridor", &Impostor::corridors},
        {"request", &Impostor::requests},
        {"map", &Impostor::maps},
        {"blocked_map", &Impostor::blocked_maps},
        {"update", &Impostor::updates},
        {"odom", &Impostor::odometry},
        {"command", &Impostor::commands},
        {"fallback_stop", &Impostor::fallback_stops},
        {"report", &Impostor::reports},
        {"cloud_of_wall", &Impostor::walls},
        {"cloud_of_nothing", &Impostor::nothings},
        {"cloud_of_garbage", &Impostor::garbage},
    };
    return all;
  }

  template <typename Message>
  void send(const runtime::Publisher<Message>& publisher, const Message& message) {
    if (publisher.publish(message)) ++sent_;
  }

  /// Calls back with every request of the navigator, as a stage that answers it would.
  void on_request(std::function<void(const msg::PlanRequest&)> callback) {
    node_.subscribe<msg::PlanRequest>(
        "plan_request", Qos::reliable_last(),
        [callback = std::move(callback)](const auto& m, const MessageInfo&) { callback(m); });
  }

  void watch_vehicle() {
    node_.subscribe<nav_msgs::msg::Odometry>("odom", Qos::best_effort(),
                                             [this](const auto& m, const MessageInfo&) {
                                               if (auto state = conversions::from_msg(m))
                                                 at_map_ = state->position_map;
                                             });
  }

  void commit_now(std::uint64_t map_version) {
    watch_vehicle();
    commits_ = node_.advertise<msg::CommittedTrajectory>("committed_trajectory", Qos::latched());
    node_.every(1.0 / options_.rate, [this, map_version] {
      if (!at_map_) return;
      const std::int64_t now_ns = node_.now_ns();
      // A newer request than any of the navigator's.
      const auto request =
          request_for(std::uint64_t(now_ns / 1000), *at_map_, options_.to_map, now_ns);
      send(commits_, commit(straight(request, *at_map_, options_.to_map), map_version, now_ns));
    });
  }
  void commits() { commit_now(1); }
  void commits_of_no_map() { commit_now(~std::uint64_t{0} - 7); }

  void trajectories() {
    trajectories_ = node_.advertise<msg::BezierTrajectory>("trajectory", Qos::reliable_last());
    on_request([this](const msg::PlanRequest& m) {
      send(trajectories_, straight(m, conversions::from_msg(m.start().position()),
                                   conversions::from_msg(m.goal().position())));
    });
  }

  void bad_trajectories() {
    trajectories_ = node_.advertise<msg::BezierTrajectory>("trajectory", Qos::reliable_last());
    on_request([this](const msg::PlanRequest& m) {
      auto bad = straight(m, conversions::from_msg(m.start().position()),
                          conversions::from_msg(m.goal().position()));
      bad.pieces().front().duration(1e-3);  // much too fast
      send(trajectories_, bad);
    });
  }

  void corridors() {
    corridors_ = node_.advertise<msg::Corridor>("corridor", Qos::reliable_last());
    on_request([this](const msg::PlanRequest& m) { send(corridors_, wide_corridor(m)); });
  }

  /// Supersedes every request of the navigator at once.
  void requests() {
    requests_ = node_.advertise<msg::PlanRequest>("plan_request", Qos::reliable_last());
    on_request([this](const msg::PlanRequest& m) {
      if (m.id() >= kOwn) return;
      auto other = m;
      other.id(kOwn + m.id());
      other.supersedes(m.id());
      send(requests_, other);
    });
  }

  /// Tells a false map as soon as the true one is known, and again and again.
  void tell_maps(msg::VoxelGrid (*lie)(msg::VoxelGrid)) {
    maps_ = node_.advertise<msg::VoxelGrid>("map/voxels", Qos::latched());
    node_.subscribe<msg::VoxelGrid>("map/voxels", Qos::latched(),
                                    [this, lie](const auto& m, const MessageInfo&) {
                                      if (m.version() < kOwn && !false_map_) false_map_ = lie(m);
                                    });
    node_.every(1.0 / options_.rate, [this] {
      if (!false_map_) return;
      false_map_->version(false_map_->version() + 1);
      send(maps_, *false_map_);
    });
  }
  void maps() { tell_maps(&all_free); }
  void blocked_maps() { tell_maps(&all_blocked); }

  void updates() {
    updates_ = node_.advertise<msg::VoxelGridUpdate>("map/voxels/updates", Qos::reliable_last(50));
    node_.subscribe<msg::VoxelGrid>("map/voxels", Qos::latched(),
                                    [this](const auto& m, const MessageInfo&) { false_map_ = m; });
    node_.every(1.0 / options_.rate, [this] {
      if (false_map_) send(updates_, freeing_update(*false_map_));
    });
  }

  /// A vehicle that drifts away, always a little newer than the true one.
  void odometry() {
    odometry_ = node_.advertise<nav_msgs::msg::Odometry>("odom", Qos::best_effort());
    node_.subscribe<nav_msgs::msg::Odometry>(
        "odom", Qos::best_effort(), [this](const auto& m, const MessageInfo& info) {
          if (!vehicle_) vehicle_ = info.writer;  // the first that was heard is the true one
          if (info.writer != *vehicle_) return;
          constexpr double kDrift_m = 0.002;  // a message
          drift_map_ += Vec3(kDrift_m, kDrift_m, 0.0);
          send(odometry_, moved(m, drift_map_, 20'000'000));
        });
  }

  void commands() {
    commands_ = node_.advertise<msg::AttitudeSetpoint>("command", Qos::best_effort());
    node_.every(1.0 / options_.rate, [this] { send(commands_, full_tilt(node_.now_ns())); });
  }

  /// Each begins where the vehicle is, so that it would be kept.
  void fallback_stops() {
    fallback_stops_ = node_.advertise<msg::FallbackStop>("fallback_stop", Qos::best_effort());
    watch_vehicle();
    node_.every(1.0 / options_.rate, [this] {
      if (at_map_) {
        send(fallback_stops_, stop_elsewhere(*at_map_, options_.to_map, node_.now_ns()));
      }
    });
  }

  /// Says in the search's name that there is no path.
  void reports() {
    reports_ = node_.advertise<msg::StageReport>("stage_report", Qos::latched(20));
    on_request([this](const msg::PlanRequest& m) {
      msg::StageReport report;
      report.header(conversions::make_header(node_.now_ns()));
      report.stage(conversions::to_msg(StageRole::path_search));
      report.node("/path_search");
      report.implementation("impostor");
      report.request_id(m.id());
      report.code("no_path");
      report.message("there is no way");
      send(reports_, report);
    });
  }

  /// As another lidar of launch file live. @param lie cloud of an eye at a place and time
  void send_clouds(std::function<sensor_msgs::msg::PointCloud2(const Vec3&, std::int64_t)> lie) {
    clouds_ = node_.advertise<sensor_msgs::msg::PointCloud2>("points", Qos::best_effort(2));
    node_.subscribe<nav_msgs::msg::Odometry>("odom", Qos::best_effort(),
                                             [this](const auto& m, const MessageInfo&) {
                                               if (auto state = conversions::from_msg(m))
                                                 at_map_ = state->position_map;
                                               stamp_ns_ = conversions::to_ns(m.header().stamp());
                                             });
    node_.every(1.0 / options_.rate, [this, lie = std::move(lie)] {
      if (at_map_) send(clouds_, lie(*at_map_, stamp_ns_));
    });
  }
  void walls() {
    send_clouds([this](const Vec3& eye, std::int64_t stamp_ns) {
      return cloud_of_wall(eye, options_.to_map, stamp_ns);
    });
  }
  void nothings() { send_clouds(&cloud_of_nothing); }
  void garbage() { send_clouds(&cloud_of_garbage); }

  static constexpr std::uint64_t kOwn = std::uint64_t{1} << 60;

  Node& node_;
  Options options_;
  long sent_ = 0;
  std::optional<Vec3> at_map_;
  std::optional<runtime::Participant> vehicle_;
  std::int64_t stamp_ns_ = 0;  // of the newest odometry
  Vec3 drift_map_ = Vec3::Zero();
  std::optional<msg::VoxelGrid> false_map_;
  runtime::Publisher<msg::CommittedTrajectory> commits_;
  runtime::Publisher<msg::BezierTrajectory> trajectories_;
  runtime::Publisher<msg::Corridor> corridors_;
  runtime::Publisher<msg::PlanRequest> requests_;
  runtime::Publisher<msg::VoxelGrid> maps_;
  runtime::Publisher<msg::VoxelGridUpdate> updates_;
  runtime::Publisher<nav_msgs::msg::Odometry> odometry_;
  runtime::Publisher<msg::AttitudeSetpoint> commands_;
  runtime::Publisher<msg::FallbackStop> fallback_stops_;
  runtime::Publisher<msg::StageReport> reports_;
  runtime::Publisher<sensor_msgs::msg::PointCloud2> clouds_;
};

bool read_numbers(std::string_view text, double* out, int count) {
  for (int k = 0; k < count; ++k) {
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), out[k]);
    if (error != std::errc{}) return false;
    text.remove_prefix(std::size_t(end - text.data()));
    if (k + 1 < count && !text.starts_with(',')) return false;
    if (k + 1 < count) text.remove_prefix(1);
  }
  return text.empty();
}

bool read(int argc, char** argv, Options& out) {
  if (argc < 2 || argc % 2 != 0) return false;
  out.lie = argv[1];
  for (int k = 2; k < argc; k += 2) {
    const std::string word = argv[k];
    if (word == "--to" && read_numbers(argv[k + 1], out.to_map.data(), 3)) continue;
    if (word == "--rate" && read_numbers(argv[k + 1], &out.rate, 1) && out.rate > 0.0) continue;
    return false;
  }
  return true;
}

int run(const Options& options) {
  const auto from_environment = runtime::ContextOptions::from_environment();
  if (!from_environment) throw std::runtime_error(from_environment.error().message);
  const auto context = runtime::Context::create(*from_environment);
  if (!context) throw std::runtime_error(context.error().message);
  Node node(**context, "impostor");
  Impostor impostor(node, options);
  if (!impostor.begin()) throw std::runtime_error("there is no lie '" + options.lie + "'");
  node.every(0.05, [&node] {
    if (g_stop) node.stop();
  });
  fmt::print("{{\"lies\": \"{}\"}}\n", options.lie);
  std::fflush(stdout);
  node.spin();
  fmt::print("{{\"sent\": {}}}\n", impostor.sent());
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  Options options;
  if (!read(argc, argv, options)) {
    fmt::print(stderr, "usage: goshawk_impostor LIE [--to x,y,z] [--rate PER_S]\n");
    return 2;
  }
  for (const int number : {SIGINT, SIGTERM}) {
    (void)signal(number, [](int) { g_stop = true; });
  }
  try {
    return run(options);
  } catch (const std::exception& e) {
    fmt::print(stderr, "goshawk_impostor: {}\n", e.what());
    return 1;
  }
}
