// goshawk_pulse NODE...: asks each node for a parameter twenty times a second, for ever, and says
// in a line of JSON when one answers again after it was silent, or from another process than
// before: {"node": "/tracker", "silent_s": 1.2}. An answer shows that both hear each other, so a
// stage that is started again and deaf is silent.

#include <fmt/format.h>
#include <signal.h>

#include <atomic>
#include <chrono>
#include <cstdio>
#include <map>
#include <stdexcept>
#include <string>
#include <utility>

#include "goshawk/runtime/node.hpp"
#include "goshawk_msgs.h"

namespace {

using namespace goshawk;
using Steady = std::chrono::steady_clock;
using goshawk_msgs::msg::ParameterAnswer;
using goshawk_msgs::msg::ParameterRequest;

constexpr double kAskEvery_s = 0.05;
constexpr double kSilence_s = 0.5;
const runtime::Qos kQos = runtime::Qos::reliable_last(50);

std::atomic<bool> g_stop = false;

struct Heard {
  Steady::time_point last{};
  runtime::Participant from{};
};

class Pulse {
 public:
  Pulse(runtime::Node& node, int count, char** names)
      : requests_(node.advertise<ParameterRequest>("/parameter_request", kQos)) {
    for (int k = 0; k < count; ++k) heard_.emplace(names[k], Heard{});
    node.subscribe<ParameterAnswer>("/parameter_answer", kQos,
                                    [this](const auto& m, const auto& info) { on_answer(m, info.writer); });
    node.every(kAskEvery_s, [this, &node] { g_stop ? node.stop() : ask(); });
  }

 private:
  void ask() {
    ParameterRequest request;
    request.client("pulse");
    request.verb(goshawk_msgs::msg::ParameterRequest_Constants::VERB_GET);
    for (const auto& [name, last] : heard_) {
      request.id(++id_);
      request.node(name);
      (void)requests_.publish(request);  // the next one follows soon
    }
  }

  void on_answer(const ParameterAnswer& answer, const runtime::Participant& from) {
    const auto at = heard_.find(answer.node());
    if (at == heard_.end() || answer.client() != "pulse") return;
    const Heard before = std::exchange(at->second, Heard{Steady::now(), from});
    const std::chrono::duration<double> silent = at->second.last - before.last;
    const bool is_first = before.last == Steady::time_point{};
    if (before.from == from && silent.count() < kSilence_s) return;
    fmt::print("{{\"node\": \"{}\", \"silent_s\": {:.3f}}}\n", answer.node(),
               is_first ? 0.0 : silent.count());
    std::fflush(stdout);
  }

  runtime::Publisher<ParameterRequest> requests_;
  std::map<std::string, Heard> heard_;
  std::uint64_t id_ = 0;
};

int run(int count, char** names) {
  const auto options = runtime::ContextOptions::from_environment();
  if (!options) throw std::runtime_error(options.error().message);
  const auto context = runtime::Context::create(*options);
  if (!context) throw std::runtime_error(context.error().message);
  runtime::Node node(**context, "pulse");
  const Pulse pulse(node, count, names);
  node.spin();
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2) {
    fmt::print(stderr, "usage: goshawk_pulse NODE...\n");
    return 2;
  }
  for (const int number : {SIGINT, SIGTERM}) {
    (void)signal(number, [](int) { g_stop = true; });
  }
  try {
    return run(argc - 1, argv + 1);
  } catch (const std::exception& e) {
    fmt::print(stderr, "goshawk_pulse: {}\n", e.what());
    return 1;
  }
}
