// bench dds: what the middleware alone costs on this machine, by way and size; and whether large
// maps disturb setpoints. The other end of each link is this program once more, as a process.

#include <signal.h>

#include <CLI/CLI.hpp>
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
  std::vector<std::string> list{this_program(), "--echo",
                                "--way",        o.way,
                                "--bytes",      std::to_string(o.bytes),
                                "--domain",     std::to_string(o.domain)};
  if (!o.reliable) list.emplace_back("--best-effort");
  if (o.asynchronous) list.emplace_back("--asynchronous");
  if (o.listener) list.emplace_back("--listener");
  return list;
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
  CLI::App app("The middleware alone, by way and size; and setpoints beside large maps.",
               "goshawk bench dds");
  LinkOptions link;
  Options options;
  bool is_echo = false, best_effort = false;
  std::string part = "all", roles;
  app.add_flag("--json", options.json, "one JSON object on standard output");
  app.add_flag("--quick", options.quick, "less of everything: ends within 40 s");
  app.add_option("--plots", options.plots, "folder for pictures and the report as JSON");
  app.add_option("--part", part, "what to measure")
      ->capture_default_str()
      ->check(CLI::IsMember({"all", "ways", "hand_over", "maps"}));
  for (const auto& [name, value] :
       {std::pair{"--echo", &is_echo}, std::pair{"--best-effort", &best_effort},
        std::pair{"--asynchronous", &link.asynchronous}, std::pair{"--listener", &link.listener}}) {
    app.add_flag(name, *value)->group("");
  }
  app.add_option("--way", link.way)->group("");
  app.add_option("--bytes", link.bytes)->group("");
  app.add_option("--domain", link.domain)->group("");
  app.add_option("--roles", roles)->group("");
  CLI11_PARSE(app, argc, argv);
  link.reliable = !best_effort;
  try {
    if (is_echo) return run_echo(link);
    if (!roles.empty()) return run_roles(roles);
    Report report("dds", options);
    return run(report, part);
  } catch (const std::exception& e) {
    std::fprintf(stderr, "goshawk bench dds: %s\n", e.what());
    return 1;
  }
}
