// bench dds: what the middleware alone costs on this machine, by way and size; and whether large
// maps disturb setpoints. The other end of each link is this program once more, as a process.

#include <signal.h>

#include <algorithm>
#include <atomic>
#include <cstdio>
#include <optional>
#include <thread>

#include "common/child.hpp"
#include "common/measure.hpp"
#include "common/report.hpp"
#include "dds/disturbance.hpp"
#include "dds/echo.hpp"
#include "goshawk/runtime/private_domain.hpp"

namespace {

using namespace goshawk::bench;

struct Size {
  const char* topic;
  std::uint32_t bytes;
};

// What our topics weigh on the wire.
constexpr Size kSizes[] = {{"setpoint", 200},    {"path", 4'000},    {"trajectory", 20'000},
                           {"corridor", 50'000}, {"map", 1'500'000}, {"large map", 12'500'000}};

volatile sig_atomic_t g_stopped = 0;

std::vector<std::string> words(const LinkOptions& o) {
  Call call;
  call["echo"] = {{"way", o.way},
                  {"bytes", o.bytes},
                  {"domain", o.domain},
                  {"reliable", o.reliable},
                  {"asynchronous", o.asynchronous},
                  {"listener", o.listener}};
  return {this_program(), call.dump()};
}

/// Both ends of a way: the other one in a process of its own, or in a thread of this.
class Link {
 public:
  explicit Link(const LinkOptions& options) : member_(options) {
    if (options.way == "one_process") {
      thread_.emplace(
          [this, options] { echo(options, &member_, [this] { return done_.load(); }); });
    } else {
      child_.emplace(words(options), options.domain);
    }
    try {
      LinkOptions here = options;
      here.listener = false;
      asker_.emplace(here, member_);
    } catch (...) {
      stop();
      throw;
    }
  }
  ~Link() { stop(); }
  Asker& asker() { return *asker_; }

 private:
  void stop() {
    done_ = true;
    if (thread_) thread_->join();
    thread_.reset();
  }

  Member member_;
  std::atomic<bool> done_ = false;
  std::optional<std::thread> thread_;
  std::optional<Child> child_;
  std::optional<Asker> asker_;
};

nlohmann::ordered_json percentiles(std::vector<double> us) {
  std::ranges::sort(us);
  return {{"p50_us", at_share(us, 0.5)},
          {"p90_us", at_share(us, 0.9)},
          {"p99_us", at_share(us, 0.99)},
          {"max_us", at_share(us, 1.0)}};
}

void add_trips(Report& report, nlohmann::ordered_json row, Trips trips) {
  row["trips"] = trips.us.size();
  row.update(percentiles(std::move(trips.us)));
  row["lost"] = trips.lost;
  report.add(std::move(row));
}

void measure_ways(Report& report, int domain) {
  const bool quick = report.options().quick;
  for (const auto& way : ways()) {
    for (const Size& size : kSizes) {
      report.progress(way + ", " + std::to_string(size.bytes) + " bytes");
      for (const bool reliable : {true, false}) {
        if (quick && !reliable) continue;
        Link link({.way = way, .bytes = size.bytes, .domain = domain, .reliable = reliable});
        if (reliable) {
          add_trips(
              report,
              {{"table", "round trip"}, {"way", way}, {"topic", size.topic}, {"bytes", size.bytes}},
              link.asker().round_trips(quick ? 300 : 3000, quick ? 0.25 : 2.0));
        }
        const Flood flood = link.asker().flood(quick ? 0.1 : 0.7);
        const double rate = flood.elapsed_s > 0.0 ? flood.received / flood.elapsed_s : 0.0;
        report.add({{"table", "throughput"},
                    {"way", way},
                    {"topic", size.topic},
                    {"bytes", size.bytes},
                    {"reliability", reliable ? "reliable" : "best effort"},
                    {"sent", flood.sent},
                    {"lost", flood.sent - flood.received},
                    {"messages_per_s", rate},
                    {"mb_per_s", rate * size.bytes * 1e-6}});
      }
    }
  }
}

/// Who calls the reader, and who sends: the choices that goshawk_runtime made.
void measure_hand_over(Report& report, int domain) {
  const bool quick = report.options().quick;
  for (const char* way : {"udp", "one_process"}) {
    for (const auto& [name, listener, asynchronous] :
         {std::tuple{"wait set, synchronous", false, false},
          std::tuple{"listener, synchronous", true, false},
          std::tuple{"wait set, asynchronous", false, true}}) {
      report.progress(std::string(way) + ", " + name);
      Link link({.way = way,
                 .bytes = 4000,
                 .domain = domain,
                 .asynchronous = asynchronous,
                 .listener = listener});
      for (const double pause_s : {0.0, 0.005}) {
        add_trips(report,
                  {{"table", "hand over, 4,000 bytes"},
                   {"way", way},
                   {"hand_over", name},
                   {"pause_ms", 1e3 * pause_s}},
                  link.asker().round_trips(quick ? 100 : 1000, quick ? 0.5 : 3.0, pause_s));
      }
    }
  }
}

void draw(Report& report) {
  const Plot common{
      .x = "bytes", .x_label = "bytes of a message", .series = "way", .log_x = true, .log_y = true};
  for (const auto& [file, title, y, label, table] :
       {std::tuple{"dds_round_trip_p50", "There and back, median", "p50_us", "us", "round trip"},
        std::tuple{"dds_round_trip_p99", "There and back, 99 of 100", "p99_us", "us", "round trip"},
        std::tuple{"dds_throughput", "Throughput, reliable", "mb_per_s", "MB/s", "throughput"}}) {
    Plot plot = common.of(file, title, y, label);
    plot.where = {{"table", table}};
    if (std::string(table) == "throughput") plot.where["reliability"] = "reliable";
    report.draw(plot);
  }
}

LinkOptions link_of(const Call& call) {
  return {.way = call.at("way"),
          .bytes = call.at("bytes"),
          .domain = call.at("domain"),
          .reliable = call.at("reliable"),
          .asynchronous = call.at("asynchronous"),
          .listener = call.at("listener")};
}

int run_echo(const LinkOptions& options) {
  for (const int number : {SIGINT, SIGTERM}) signal(number, [](int) { g_stopped = 1; });
  echo(options, nullptr, [] { return g_stopped != 0; });
  return 0;
}

int run(Report& report, const std::string& part) {
  const int domain = goshawk::runtime::hold_private_domain().value();
  if (part == "all" || part == "ways") measure_ways(report, domain);
  if (part == "all" || part == "hand_over") measure_hand_over(report, domain);
  if (part == "all" || part == "maps") measure_disturbance(report, domain);
  draw(report);
  return report.finish();
}

}  // namespace

int main(int argc, char** argv) {
  return bench_call(argc, argv, "dds", [](const Call& call) {
    // The other end of a way, or other processes of a measurement: children of this program.
    if (call.contains("echo")) return run_echo(link_of(call["echo"]));
    if (call.contains("roles")) return run_roles(call["roles"]);
    Report report("dds", Options::of(call));
    return run(report, call.at("part"));
  });
}
