#include <cstdio>
#include <filesystem>
#include <fstream>

#include "folders.hpp"
#include "goshawk/conformance/conform.hpp"
#include "goshawk/runtime/component.hpp"
#include "flight/launch_process.hpp"
#include "verbs.hpp"

namespace goshawk::cli {
namespace {

struct ConformOptions {
  conformance::Options kit;
  bool running = false;
  std::string launch;
  bool json = false;
};

Json to_json(const conformance::Report& report) {
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
  std::printf("%s, implementation %s\n", report.stage.c_str(), report.implementation.c_str());
  int passed = 0;
  for (const auto& item : report.items) {
    passed += item.passed ? 1 : 0;
    std::printf("  %s  %-42s %s\n", item.passed ? "pass" : "FAIL", item.name.c_str(),
                item.detail.c_str());
  }
  std::printf("%d of %zu passed; latency p50 %.2f ms, p99 %.2f ms, max %.2f ms\n", passed,
              report.items.size(), 1e3 * report.latency_p50_s, 1e3 * report.latency_p99_s,
              1e3 * report.latency_max_s);
}

// Our own component, where no other is named.
Result<std::string> launch_file(const ConformOptions& o, const std::string& folder) {
  if (!o.launch.empty()) return o.launch;
  const std::string file = folder + "/stage.yaml";
  // The map server begins with a box of unknown space, for the kit to look around in.
  const char* params = o.kit.stage == "map_server" ? ", params: {use_box: true}" : "";
  std::ofstream(file) << "stages: [{component: " << o.kit.stage << params << "}]\n";
  return file;
}

Result<conformance::Report> examine(const ConformOptions& o, const std::string& folder) {
  auto options = runtime::ContextOptions::from_environment();
  if (!options) return options.error();
  std::optional<LaunchProcess> launch;
  if (!o.running) {
    const auto domain = private_domain();
    if (!domain) return domain.error();
    options->domain = *domain;
    const auto file = launch_file(o, folder);
    if (!file) return file.error();
    auto started =
        LaunchProcess::start({*file, "--log-dir", folder}, *domain, folder + "/launch.log");
    if (!started) return started.error();
    launch.emplace(*std::move(started));
  }
  auto context = runtime::Context::create(*options);
  if (!context) return context.error();
  return conformance::conform(**context, o.kit);
}

int run(ConformOptions o) {
  o.kit.fresh = !o.running;
  const TemporaryFolder folder;
  const auto report = examine(o, folder.path());
  if (!report) {
    const bool wrong = report.code() == ErrorCode::invalid_parameter;
    return report_failure(report.error(), o.json, wrong ? kWrongCall : kNotDone);
  }
  o.json ? print_json(to_json(*report)) : print(*report);
  return report->passed() ? kDone : kNotDone;
}

}  // namespace

int conform_command(const Arguments& arguments) {
  CLI::App app(
      "Examine a stage, whoever wrote it: good and bad requests on its topics, every answer "
      "judged.",
      "goshawk conform");
  app.footer(
      "Examples:\n"
      "  goshawk conform path_search\n"
      "  goshawk conform path_search --launch mine.yaml --input flight.mcap\n"
      "  goshawk conform tracker --against-running");
  ConformOptions o;
  app.add_option("stage", o.kit.stage,
                 "path_search, corridor_builder, trajectory_optimizer, tracker or map_server")
      ->required();
  app.add_option("--input", o.kit.input,
                 "an MCAP recording, whose requests are asked beside the generated ones");
  auto* running = app.add_flag("--against-running", o.running,
                               "what runs already, in ROS_DOMAIN_ID (its map is replaced)");
  app.add_option("--launch", o.launch, "launch file that starts the stage, and nothing else")
      ->excludes(running);
  app.add_option("--namespace", o.kit.node_namespace, "as in /uav1")->capture_default_str();
  app.add_option("-n,--requests", o.kit.requests, "good requests")
      ->capture_default_str()
      ->check(CLI::Range(1, 10'000));
  app.add_option("--seed", o.kit.seed, "of the map and the requests")
      ->capture_default_str()
      ->check(not_negative());
  app.add_option("--timeout", o.kit.timeout_s, "[s] longest wait for an answer")
      ->capture_default_str()
      ->check(CLI::Range(0.01, 100.0));
  app.add_flag("--json", o.json, "print one JSON object (docs/cli.md)");
  if (const auto status = parse(app, arguments)) return *status;
  const auto known = conformance::stages();
  if (std::ranges::find(known, o.kit.stage) == known.end()) o.running = true;  // nothing to start
  return run(o);
}

}  // namespace goshawk::cli
