#include "goshawk/conformance/conform.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>

#include "flight/child_verb.hpp"
#include "goshawk/runtime/context.hpp"
#include "process.hpp"
#include "values.hpp"
#include "verbs/verbs.hpp"

namespace goshawk::cli {
namespace {

struct ConformOptions {
  conformance::Options kit;
  bool running = false;
  std::string launch;
};

Json report_json(const conformance::Report& report) {
  Json items = Json::array();
  for (const auto& item : report.items) {
    items.push_back({{"name", item.name}, {"passed", item.passed}, {"detail", item.detail}});
  }
  return {{"ok", report.passed()},
          {"code", report.passed() ? "ok" : "invalid_input"},
          {"message", report.passed() ? "" : "the stage does not conform: see items"},
          {"stage", report.stage},
          {"implementation", report.implementation},
          {"latency",
           {{"p50_ms", 1e3 * report.latency_p50_s},
            {"p99_ms", 1e3 * report.latency_p99_s},
            {"max_ms", 1e3 * report.latency_max_s}}},
          {"items", items}};
}

void print(const conformance::Report& report) {
  fmt::print("{}, implementation {}\n", report.stage, report.implementation);
  for (const auto& item : report.items) {
    fmt::print("  {}  {:<42} {}\n", item.passed ? "pass" : "FAIL", item.name, item.detail);
  }
  fmt::print("{} of {} passed; latency p50 {:.2f} ms, p99 {:.2f} ms, max {:.2f} ms\n",
             std::ranges::count_if(report.items, [](const auto& i) { return i.passed; }),
             report.items.size(), 1e3 * report.latency_p50_s, 1e3 * report.latency_p99_s,
             1e3 * report.latency_max_s);
}

/// A launch file for our own component.
std::string write_launch_file(const std::string& stage, const std::string& folder) {
  const std::string file = folder + "/stage.yaml";
  // The map server begins with a box of unknown space, for the kit to look around in.
  const char* params = stage == "map_server" ? ", params: {use_box: true}" : "";
  std::ofstream(file) << fmt::format("stages: [{{component: {}{}}}]\n", stage, params);
  return file;
}

Result<ChildVerb> start_stage(const ConformOptions& o, int domain) {
  const auto folder = make_log_folder("conform");
  if (!folder) return folder.error();
  const auto file = o.launch.empty() ? write_launch_file(o.kit.stage, *folder) : o.launch;
  return start_launch({file, "--log-dir", *folder}, domain, *folder + "/launch.log");
}

Result<conformance::Report> examine(const ConformOptions& o) {
  auto options = runtime::ContextOptions::from_environment();
  if (!options) return options.error();
  std::optional<ChildVerb> launch;
  if (!o.running) {
    const auto domain = private_domain();
    if (!domain) return domain.error();
    options->domain = *domain;
    auto started = start_stage(o, *domain);
    if (!started) return started.error();
    launch.emplace(*std::move(started));
  }
  auto context = runtime::Context::create(*options);
  if (!context) return context.error();
  auto report = conformance::conform(**context, o.kit);
  // A stage that could not be started explains the silence.
  if (!report && launch && launch->ended()) return launch->failure();
  return report;
}

int run_conform(ConformOptions o, const Console& console) {
  o.kit.fresh = !o.running;
  const auto report = examine(o);
  if (!report) return console.failed(report.error());
  console.json() ? console.print(report_json(*report)) : print(*report);
  return report->passed() ? kDone : kNotDone;
}

}  // namespace

void add_conform(Program& program) {
  const Verb verb = program.verb(
      "conform", "examine a stage of any make: good and bad requests, every answer judged");
  auto o = std::make_shared<ConformOptions>();
  verb.choice("stage", o->kit.stage, "one of the stages below", conformance::stages())
      ->required();
  verb->add_option("--input", o->kit.input,
                   "an MCAP recording whose requests are asked beside the generated ones");
  auto* running = verb->add_flag("--against-running", o->running,
                                 "what already runs in ROS_DOMAIN_ID (its map is replaced)");
  verb->add_option("--launch", o->launch, "launch file that starts the stage, and nothing else")
      ->excludes(running);
  verb->add_option("--namespace", o->kit.node_namespace, "as in /uav1")->capture_default_str();
  verb->add_option("-n,--requests", o->kit.requests, "good requests")
      ->capture_default_str()
      ->check(CLI::Range(1, 10'000));
  verb->add_option("--seed", o->kit.seed, "of the map and the requests")
      ->capture_default_str()
      ->check(not_negative());
  verb->add_option("--timeout", o->kit.timeout_s, "[s] longest wait for an answer")
      ->capture_default_str()
      ->check(CLI::Range(0.01, 100.0));
  verb->footer(
      "Stages: path_search, corridor_builder, trajectory_optimizer, tracker, map_server.\n\n"
      "Examples:\n"
      "  goshawk conform path_search\n"
      "  goshawk conform path_search --launch mine.yaml --input flight.mcap\n"
      "  goshawk conform tracker --against-running");
  verb.runs([o](const Console& console) { return run_conform(*o, console); });
}

}  // namespace goshawk::cli
