// bench stage STAGE --input RECORDING: feeds a stage with recorded inputs over DDS, ours and
// another one's, and tells computing from the wire.

#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <thread>

#include "common/report.hpp"
#include "goshawk/conversions/plan.hpp"
#include "goshawk/recording/reader.hpp"
#include "goshawk/runtime/node.hpp"

namespace {

using namespace goshawk;
using namespace goshawk::runtime;
namespace msg = goshawk_msgs::msg;

struct Call {
  std::string stage, input, against;
  int count = 200;
  double rate_hz = 0.0;  // 0: the next request when the answer is there
  double timeout_s = 2.0;
  int domain = 0;
};

/// A program in a domain, stopped with this object.
class Child {
 public:
  Child(const std::string& command, int domain) {
    setenv("ROS_DOMAIN_ID", std::to_string(domain).c_str(), 1);
    const std::string line = "exec " + command + " >/dev/null 2>&1";
    const char* words[] = {"/bin/sh", "-c", line.c_str(), nullptr};
    if (posix_spawn(&pid_, words[0], nullptr, nullptr, const_cast<char**>(words), environ) != 0) {
      pid_ = -1;
    }
  }
  ~Child() {
    if (pid_ <= 0) return;
    kill(pid_, SIGTERM);
    waitpid(pid_, nullptr, 0);
  }
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;

 private:
  pid_t pid_ = -1;
};

struct Samples {
  std::vector<double> compute_us, wire_us, total_us;
  int sent = 0, lost = 0;
  double elapsed_s = 0.0;
};

msg::PlanRequest& request_of(msg::PlanRequest& m) {
  return m;
}
template <typename Message>
msg::PlanRequest& request_of(Message& m) {
  return m.request();
}

/// All messages of a topic; those that are no such message are left out.
template <typename Message>
std::vector<Message> load(recording::Reader& reader, const std::string& topic) {
  std::vector<Message> messages;
  recording::ReadOptions options;
  options.channels.emplace();
  for (const auto& [id, channel] : reader.channels()) {
    if (channel.topic.ends_with("/" + topic)) options.channels->insert(id);
  }
  const auto read = reader.read(options, [&](const recording::MessageView& m) {
    Message message;
    if (decode<Message>({m.data.begin(), m.data.end()}, message)) messages.push_back(message);
    return true;
  });
  if (!read) std::fprintf(stderr, "%s\n", read.error().message.c_str());
  return messages;
}

template <typename Input, typename Output>
Result<Samples> measure(const Call& call, const std::string& command, const std::string& in,
                        const std::string& out, recording::Reader& reader) {
  auto inputs = load<Input>(reader, in);
  if (inputs.empty()) {
    return fail(ErrorCode::invalid_input, call.input + " has no messages on " + in);
  }
  const auto maps = load<msg::VoxelGrid>(reader, "map/voxels");
  const Child child(command, call.domain);
  ContextOptions context_options;
  context_options.domain = call.domain;
  auto context = Context::create(context_options);
  if (!context) return context.error();
  Node node(**context, "goshawk_bench_stage");
  const auto map = node.advertise<msg::VoxelGrid>("map/voxels", Qos::latched());
  const auto publisher = node.advertise<Input>(in, Qos::reliable_last());
  Samples samples;
  std::uint64_t id = 0;
  std::int64_t sent_ns = 0;
  bool answered = false;
  node.subscribe<Output>(out, Qos::reliable_last(100), [&](const Output& m, const MessageInfo& i) {
    if (m.request().id() != id || answered) return;
    answered = true;
    const double total_us = 1e-3 * double(i.received_ns - sent_ns);
    samples.total_us.push_back(total_us);
    samples.compute_us.push_back(1e-3 * double(m.compute_ns()));
    samples.wire_us.push_back(total_us - samples.compute_us.back());
  });
  const auto wait = [&](double seconds, const auto& done) {
    const auto end_ns = node.now_ns() + std::int64_t(1e9 * seconds);
    while (!done() && node.now_ns() < end_ns) node.spin_some(0.02);
    return done();
  };
  if (!wait(20.0, [&] { return publisher.matched() > 0; })) {
    return fail(ErrorCode::stage_silent, "nobody reads " + in + ": does '" + command + "' run?");
  }
  if (!maps.empty()) (void)map.publish(maps.back());
  wait(1.0, [] { return false; });
  constexpr int kWarm = 10;
  std::int64_t begin_ns = 0;
  for (int k = 0; k < call.count + kWarm; ++k) {
    if (k == kWarm) {
      samples = {};
      begin_ns = node.now_ns();
    }
    Input input = inputs[std::size_t(k) % inputs.size()];
    answered = false;
    request_of(input).id(id = std::uint64_t(k) + 1);
    sent_ns = node.now_ns();
    request_of(input).header().stamp(conversions::to_stamp(sent_ns));
    input.header().stamp(conversions::to_stamp(sent_ns));
    ++samples.sent;
    if (auto status = publisher.publish(input); !status) return status.error();
    if (!wait(call.timeout_s, [&] { return answered; })) ++samples.lost;
    if (call.rate_hz > 0.0) {
      const double left_s = 1.0 / call.rate_hz - 1e-9 * double(node.now_ns() - sent_ns);
      wait(left_s, [] { return false; });
    }
  }
  samples.elapsed_s = 1e-9 * double(node.now_ns() - begin_ns);
  return samples;
}

double at(std::vector<double> values, double share) {
  if (values.empty()) return 0.0;
  std::ranges::sort(values);
  return values[std::size_t(share * double(values.size() - 1) + 0.5)];
}

void add_rows(bench::Report& report, const std::string& name, const Samples& s) {
  for (const auto& [what, values] :
       {std::pair{"compute", &s.compute_us}, std::pair{"transport", &s.wire_us},
        std::pair{"total", &s.total_us}}) {
    report.add({{"table", "latency [us]"},
                {"implementation", name},
                {"part", what},
                {"p50_us", at(*values, 0.5)},
                {"p90_us", at(*values, 0.9)},
                {"p99_us", at(*values, 0.99)},
                {"max_us", at(*values, 1.0)}});
  }
  report.add({{"table", "requests"},
              {"implementation", name},
              {"sent", s.sent},
              {"lost", s.lost},
              {"answers_per_s", double(s.sent - s.lost) / s.elapsed_s}});
}

Result<Samples> measure(const Call& call, const std::string& command, recording::Reader& reader) {
  if (call.stage == "path_search") {
    return measure<msg::PlanRequest, msg::Path>(call, command, "plan_request", "path", reader);
  }
  if (call.stage == "corridor_builder") {
    return measure<msg::Path, msg::Corridor>(call, command, "path", "corridor", reader);
  }
  return measure<msg::Corridor, msg::BezierTrajectory>(call, command, "corridor", "trajectory",
                                                       reader);
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("A stage fed from a recording, over DDS: computing, transport, loss.",
               "goshawk bench stage");
  Call call;
  bench::Options options;
  app.add_option("stage", call.stage)
      ->required()
      ->check(CLI::IsMember({"path_search", "corridor_builder", "trajectory_optimizer"}));
  app.add_option("--input", call.input, "an MCAP recording with the stage's inputs")->required();
  app.add_option("--against", call.against, "command of another implementation, beside ours");
  app.add_option("-n,--count", call.count, "requests")
      ->capture_default_str()
      ->check(CLI::Range(1, 1'000'000));
  app.add_option("--rate", call.rate_hz, "[Hz] 0: as fast as answers come")->capture_default_str();
  app.add_option("--plots", options.plots, "folder for pictures");
  app.add_flag("--quick", options.quick, "less of everything");
  app.add_flag("--json", options.json, "one JSON object");
  CLI11_PARSE(app, argc, argv);
  if (options.quick) call.count = std::min(call.count, 50);
  auto reader = recording::Reader::open(call.input);
  if (!reader) {
    std::fprintf(stderr, "goshawk bench stage: %s\n", reader.error().message.c_str());
    return 1;
  }
  const auto self = std::filesystem::read_symlink("/proc/self/exe").parent_path();
  const std::string ours = (self / "../../bin/goshawk_container").string() + " " + call.stage;
  bench::Report report("stage", options);
  call.domain = 101 + int(getpid()) % 60;
  for (const auto& [name, command] : {std::pair{call.stage, ours}, {call.against, call.against}}) {
    if (command.empty()) continue;
    report.progress(name);
    const auto samples = measure(call, command, *reader);
    if (!samples) {
      std::fprintf(stderr, "goshawk bench stage: %s\n", samples.error().message.c_str());
      return 1;
    }
    add_rows(report, name, *samples);
    call.domain += 60;
  }
  return report.finish();
}
