// goshawk_runtime_peer ROLE ...: one end of a measurement between processes, on topics of its own.
//
//   join PEERS NAME         waits until PEERS others' first message came; prints the milliseconds
//   echo                    answers ping with pong
//   ping COUNT BYTES        round trips; prints half of them as p50 and p99 in us
//   latch BYTES             latches a message and stays; prints the growth of its memory
//   fetch                   waits for the latched message; prints the milliseconds from start
//   hear                    reads a state topic, reliable, until it is ended
//   state COUNT QUALITY [PID]
//                           publishes COUNT states of 1 KB at 500 Hz, reliable or best_effort, and
//                           prints how long the calls took in us; with PID only once a reader is
//                           matched, and that process is stopped meanwhile

#include <signal.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <set>
#include <string>
#include <thread>

#include "goshawk/runtime/node.hpp"
#include "octomap_msgs.h"
#include "std_msgs.h"

namespace {

using namespace goshawk::runtime;
using octomap_msgs::msg::Octomap;
using std_msgs::msg::String;
using Steady = std::chrono::steady_clock;

const auto g_start = Steady::now();

double ms_since(Steady::time_point begin) {
  return std::chrono::duration<double, std::milli>(Steady::now() - begin).count();
}

double resident_mb() {
  std::ifstream statm("/proc/self/statm");
  long total = 0, resident = 0;
  statm >> total >> resident;
  return double(resident) * double(sysconf(_SC_PAGESIZE)) / 1e6;
}

int join(Node& node, int peers, const std::string& name) {
  const auto publisher = node.advertise<String>("measure/hello", Qos::latched());
  String hello;
  hello.data(name);
  (void)publisher.publish(hello);
  std::set<std::string> met;
  node.subscribe<String>("measure/hello", Qos::latched(100), [&](const String& m, const auto&) {
    if (m.data() != name) met.insert(m.data());
  });
  while (int(met.size()) < peers && ms_since(g_start) < 20'000) node.spin_some(0.05);
  std::printf("%zu@%.0f\n", met.size(), ms_since(g_start));
  std::fflush(stdout);
  const auto done = Steady::now();
  while (ms_since(done) < 3000) node.spin_some(0.05);  // others still need this one
  return int(met.size()) == peers ? 0 : 1;
}

int echo(Node& node) {
  const auto pong = node.advertise<Octomap>("measure/pong", Qos::reliable_last());
  node.subscribe<Octomap>("measure/ping", Qos::reliable_last(),
                          [&](const Octomap& m, const auto&) { (void)pong.publish(m); });
  node.spin();
  return 0;
}

int ping(Node& node, int count, std::size_t bytes) {
  const auto publisher = node.advertise<Octomap>("measure/ping", Qos::reliable_last());
  bool answered = false;
  node.subscribe<Octomap>("measure/pong", Qos::reliable_last(),
                          [&](const Octomap&, const auto&) { answered = true; });
  Octomap message;
  message.data().resize(bytes);
  std::vector<double> us;
  for (int i = -count / 10; i < count;) {
    answered = false;
    const auto begin = Steady::now();
    (void)publisher.publish(message);
    while (!answered && ms_since(begin) < 1000) node.spin_some(0.1);
    if (!answered) continue;  // not met yet
    if (i++ >= 0) us.push_back(ms_since(begin) * 500);
  }
  std::ranges::sort(us);
  std::printf("%zu B: p50 %.0f us, p99 %.0f us (half a round trip, %d of them)\n", bytes,
              us[us.size() / 2], us[us.size() * 99 / 100], count);
  return 0;
}

int latch(Node& node, std::size_t bytes) {
  const auto publisher = node.advertise<Octomap>("measure/latched", Qos::latched());
  const double before = resident_mb();
  {
    Octomap message;
    message.data().assign(bytes, 1);
    (void)publisher.publish(message);
  }
  std::printf("memory grew by %.1f MB\n", resident_mb() - before);
  std::fflush(stdout);
  node.spin();
  return 0;
}

int fetch(Node& node) {
  std::size_t got = 0;
  node.subscribe<Octomap>("measure/latched", Qos::latched(),
                          [&](const Octomap& m, const auto&) { got = m.data().size(); });
  while (got == 0 && ms_since(g_start) < 30'000) node.spin_some(0.1);
  std::printf("%zu bytes after %.0f ms\n", got, ms_since(g_start));
  return got > 0 ? 0 : 1;
}

int hear(Node& node) {
  node.subscribe<Octomap>("measure/state", Qos::state(), [](const Octomap&, const auto&) {});
  node.spin();
  return 0;
}

int state(Node& node, int count, bool reliable, pid_t silent) {
  constexpr auto kPeriod = std::chrono::milliseconds(2);
  const auto publisher =
      node.advertise<Octomap>("measure/state", reliable ? Qos::state() : Qos::best_effort());
  if (silent > 0) {
    while (publisher.matched() == 0) node.spin_some(0.05);
    if (kill(silent, SIGSTOP) != 0) return 1;
  }
  Octomap message;
  message.data().resize(1024);
  std::vector<double> us;
  int failed = 0;
  auto next = Steady::now();
  for (int i = 0; i < count; ++i) {
    std::this_thread::sleep_until(next += kPeriod);
    const auto begin = Steady::now();
    failed += publisher.publish(message) ? 0 : 1;
    us.push_back(ms_since(begin) * 1e3);
  }
  if (silent > 0) kill(silent, SIGCONT);
  std::ranges::sort(us);
  std::printf("p50 %.0f us, p99 %.0f us, longest %.0f us, %d failed, %d matched\n",
              us[us.size() / 2], us[us.size() * 99 / 100], us.back(), failed, publisher.matched());
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  const std::vector<std::string> a(argv + 1, argv + argc);
  auto options = ContextOptions::from_environment();
  if (!options) return 2;
  auto context = Context::create(*options);
  if (!context) {
    std::fprintf(stderr, "%s\n", context.error().message.c_str());
    return 1;
  }
  Node node(**context, "peer");
  if (a.size() == 3 && a[0] == "join") return join(node, std::atoi(a[1].c_str()), a[2]);
  if (a.size() == 1 && a[0] == "echo") return echo(node);
  if (a.size() == 3 && a[0] == "ping") {
    return ping(node, std::atoi(a[1].c_str()), std::size_t(std::atol(a[2].c_str())));
  }
  if (a.size() == 2 && a[0] == "latch") return latch(node, std::size_t(std::atol(a[1].c_str())));
  if (a.size() == 1 && a[0] == "fetch") return fetch(node);
  if (a.size() == 1 && a[0] == "hear") return hear(node);
  if ((a.size() == 3 || a.size() == 4) && a[0] == "state" && std::atoi(a[1].c_str()) > 0) {
    return state(node, std::atoi(a[1].c_str()), a[2] == "reliable",
                 a.size() == 4 ? std::atoi(a[3].c_str()) : 0);
  }
  std::fprintf(stderr,
               "goshawk_runtime_peer join|echo|ping|latch|fetch|hear|state; see its source\n");
  return 2;
}
