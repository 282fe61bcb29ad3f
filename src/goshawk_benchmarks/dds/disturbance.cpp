#include "dds/disturbance.hpp"

#include <signal.h>

#include <algorithm>
#include <memory>
#include <stdexcept>
#include <thread>

#include "common/call.hpp"
#include "common/child.hpp"
#include "common/measure.hpp"
#include "goshawk/conversions/geometry.hpp"
#include "goshawk/runtime/node.hpp"
#include "goshawk_msgs.h"

namespace goshawk::bench {
namespace {

using namespace goshawk::runtime;
namespace msg = goshawk_msgs::msg;

constexpr double kSetpointPeriod_s = 0.005, kMapPeriod_s = 0.5;
constexpr std::uint32_t kMap_byte = 12'500'000;
constexpr double kMeet_s = 20.0;
constexpr std::size_t kMet = 20;  // setpoints: the two have found each other

std::unique_ptr<Context> join(int domain) {
  ContextOptions options;
  options.domain = domain;
  auto context = Context::create(options);
  if (!context) throw std::runtime_error(context.error().message);
  return *std::move(context);
}

/// A node with a thread, as a stage in the container.
class Running {
 public:
  Running(Context& context, const std::string& name) : node_(context, name) {}
  virtual ~Running() = default;
  Node& node() { return node_; }
  void start() {
    thread_ = std::thread([this] { node_.spin(); });
  }
  void stop() {
    node_.stop();
    if (thread_.joinable()) thread_.join();
  }

 private:
  Node node_;
  std::thread thread_;
};

class SetpointWriter : public Running {
 public:
  explicit SetpointWriter(Context& context)
      : Running(context, "setpoint_writer"),
        publisher_(node().advertise<msg::AttitudeSetpoint>("command", Qos::best_effort())) {
    node().every(kSetpointPeriod_s, [this] {
      message_.thrust(++number_);
      message_.header(conversions::make_header(node().now_ns()));
      (void)publisher_.publish(message_);
    });
  }

 private:
  Publisher<msg::AttitudeSetpoint> publisher_;
  msg::AttitudeSetpoint message_;
  double number_ = 0.0;
};

class MapWriter : public Running {
 public:
  explicit MapWriter(Context& context)
      : Running(context, "map_writer"),
        publisher_(node().advertise<msg::VoxelGrid>("map/voxels", Qos::latched())) {
    message_.grown().assign(kMap_byte / 8, 0x5555555555555555);
    node().every(kMapPeriod_s, [this] {
      message_.header(conversions::make_header(node().now_ns()));
      (void)publisher_.publish(message_);
    });
  }

 private:
  Publisher<msg::VoxelGrid> publisher_;
  msg::VoxelGrid message_;
};

class MapReader : public Running {
 public:
  explicit MapReader(Context& context) : Running(context, "map_reader") {
    node().subscribe<msg::VoxelGrid>("map/voxels", Qos::latched(),
                                     [](const msg::VoxelGrid&, const MessageInfo&) {});
  }
};

class SetpointReader : public Running {
 public:
  explicit SetpointReader(Context& context) : Running(context, "setpoint_reader") {
    us.reserve(1 << 16);
    node().subscribe<msg::AttitudeSetpoint>(
        "command", Qos::best_effort(),
        [this](const msg::AttitudeSetpoint& m, const MessageInfo& i) {
          if (us.empty()) first_ = m.thrust();
          last_ = m.thrust();
          us.push_back(double(i.received_ns - conversions::to_ns(m.header().stamp())) * 1e-3);
        });
  }
  int lost() const { return us.empty() ? 0 : int(last_ - first_) + 1 - int(us.size()); }
  std::vector<double> us;

 private:
  double first_ = 0.0, last_ = 0.0;
};

using Nodes = std::vector<std::unique_ptr<Running>>;

Nodes make(const std::string& roles, Context& context) {
  Nodes nodes;
  for (const char role : roles) {
    if (role == 's') nodes.push_back(std::make_unique<SetpointWriter>(context));
    if (role == 'm') nodes.push_back(std::make_unique<MapWriter>(context));
    if (role == 'n') nodes.push_back(std::make_unique<MapReader>(context));
  }
  return nodes;
}

/// Which nodes share a process; the setpoints are always read here.
struct Arrangement {
  const char* name;
  std::string here;                 // roles beside the reader of the setpoints
  std::vector<std::string> others;  // roles of each other process
};

struct Sample {
  std::vector<double> us;
  int lost = 0;
};

void wait_for(SetpointReader& reader, std::size_t count, double most_s) {
  const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(most_s);
  while (reader.us.size() < count && std::chrono::steady_clock::now() < end) {
    reader.node().spin_some(0.05);
  }
}

// Without maps, what would write or read them is not started.
std::string without_maps(std::string roles, bool with_maps) {
  if (!with_maps) std::erase_if(roles, [](char role) { return role != 's'; });
  return roles;
}

/// @param settle_s in which the maps begin
Sample measure(const Arrangement& arrangement, bool with_maps, double settle_s, double time_s,
               int domain) {
  const auto context = join(domain);
  SetpointReader reader(*context);
  Nodes here = make(without_maps(arrangement.here, with_maps), *context);
  std::vector<std::unique_ptr<Child>> children;
  for (const auto& other : arrangement.others) {
    const std::string roles = without_maps(other, with_maps);
    if (roles.empty()) continue;
    Call call;
    call["roles"] = roles;
    children.push_back(std::make_unique<Child>(
        std::vector<std::string>{this_program(), call.dump()}, domain));
  }
  for (auto& node : here) node->start();
  wait_for(reader, kMet, kMeet_s);
  const bool met = reader.us.size() >= kMet;
  wait_for(reader, std::size_t(-1), settle_s);
  Sample sample;
  if (met) {
    reader.us.clear();
    wait_for(reader, std::size_t(-1), time_s);
    sample = {std::move(reader.us), reader.lost()};
  }
  for (auto& node : here) node->stop();
  if (!met) throw std::runtime_error(std::string("no setpoints came: ") + arrangement.name);
  return sample;
}

struct Turns {
  std::vector<double> us;      // of all turns
  std::vector<double> p99_us;  // of each
  int lost = 0;

  void add(Sample sample) {
    std::ranges::sort(sample.us);
    p99_us.push_back(at_share(sample.us, 0.99));
    us.insert(us.end(), sample.us.begin(), sample.us.end());
    lost += sample.lost;
  }
};

}  // namespace

void measure_disturbance(Report& report, int domain) {
  std::vector<Arrangement> arrangements = {
      {"a process each", "", {"s", "m", "n"}},
      {"writers in one, readers in another", "n", {"sm"}},
      {"one process", "smn", {}},
      {"one process, and a reader of maps outside", "sm", {"n"}}};
  if (report.options().quick) arrangements.pop_back();
  // In short turns, so that a busy machine disturbs both alike; the quietest turn of each tells
  // what the maps alone do.
  const int turns = report.options().quick ? 1 : 6;
  const double settle_s = report.options().quick ? 0.6 : 1.4;
  const double time_s = report.options().quick ? 0.7 : 2.5;
  for (const auto& arrangement : arrangements) {
    Turns of[2];
    for (int turn = 0; turn < 2 * turns; ++turn) {
      const bool with_maps = turn % 2 == 1;
      report.progress(std::string(arrangement.name) + (with_maps ? ", with maps" : ""));
      of[int(with_maps)].add(measure(arrangement, with_maps, settle_s, time_s, domain));
    }
    for (const bool with_maps : {false, true}) {
      auto& [us, p99_us, lost] = of[int(with_maps)];
      std::ranges::sort(us);
      std::ranges::sort(p99_us);
      report.add({{"table", "setpoints at 200 Hz"},
                  {"arrangement", arrangement.name},
                  {"maps_of_12.5_mb", with_maps ? "2 Hz" : "none"},
                  {"setpoints", us.size()},
                  {"p50_us", at_share(us, 0.5)},
                  {"p90_us", at_share(us, 0.9)},
                  {"p99_us", at_share(us, 0.99)},
                  {"max_us", at_share(us, 1.0)},
                  {"p99_us_of_median_turn", at_share(p99_us, 0.5)},
                  {"p99_us_of_quietest_turn", at_share(p99_us, 0.0)},
                  {"lost", lost}});
    }
  }
}

int run_roles(const std::string& roles) {
  sigset_t signals;
  sigemptyset(&signals);
  sigaddset(&signals, SIGINT);
  sigaddset(&signals, SIGTERM);
  pthread_sigmask(SIG_BLOCK, &signals, nullptr);
  const auto options = ContextOptions::from_environment();
  if (!options) return 2;
  const auto context = join(options->domain);
  Nodes nodes = make(roles, *context);
  for (auto& node : nodes) node->start();
  int number = 0;
  sigwait(&signals, &number);
  for (auto& node : nodes) node->stop();
  return 0;
}

}  // namespace goshawk::bench
