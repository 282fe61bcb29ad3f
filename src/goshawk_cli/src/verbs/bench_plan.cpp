#include <fmt/format.h>

#include <algorithm>

#include "bench/plan_timer.hpp"
#include "flight/child_verb.hpp"
#include "goshawk/map_server/octree.hpp"
#include "planning/planning.hpp"
#include "process.hpp"
#include "values.hpp"
#include "verbs/bench.hpp"

namespace goshawk::cli {
namespace {

constexpr std::size_t kWarmUp = 10;  // plans that do not count
constexpr int kMostFailures = 10;    // the map may not be there for the first plans
constexpr double kStagesReady_s = 30.0;
constexpr double kPlan_s = 2.0;

struct BenchOptions {
  MapOptions map;
  Vec3 start_map = Vec3(3.0, 0.0, 1.0);
  Vec3 goal_map = Vec3(3.0, 8.0, 2.0);
  std::string launch = "flight";
  int count = 200;
};

double percentile_us(std::vector<std::int64_t> values, double share) {
  if (values.empty()) return 0.0;
  std::ranges::sort(values);
  const auto at = std::size_t(share * double(values.size() - 1) + 0.5);
  return double(values[at]) * 1e-3;
}

Json percentiles(const std::vector<std::int64_t>& values) {
  return {{"p50_us", percentile_us(values, 0.5)},
          {"p90_us", percentile_us(values, 0.9)},
          {"p99_us", percentile_us(values, 0.99)},
          {"max_us", percentile_us(values, 1.0)}};
}

Json stage_json(const std::vector<PlanSample>& samples, const std::string& name) {
  std::vector<std::int64_t> compute;
  std::vector<std::int64_t> wire;
  for (const auto& s : samples) {
    const auto found = s.stages.find(name);
    if (found == s.stages.end()) continue;
    compute.push_back(found->second.compute_ns);
    wire.push_back(found->second.wire_ns);
  }
  return {{"name", name}, {"compute", percentiles(compute)}, {"wire", percentiles(wire)}};
}

Json result_json(const std::vector<PlanSample>& samples, const BenchOptions& o) {
  std::vector<std::int64_t> totals;
  std::vector<std::int64_t> wires;
  for (const auto& s : samples) {
    std::int64_t compute_ns = 0;
    for (const auto& [name, times] : s.stages) compute_ns += times.compute_ns;
    totals.push_back(s.total_ns);
    wires.push_back(s.total_ns - compute_ns);
  }
  Json stages = Json::array();
  for (const char* name : kPlanningStages) stages.push_back(stage_json(samples, name));
  stages.push_back(stage_json(samples, "reply"));
  Json object = ok_json();
  object.update({{"launch", o.launch},
                 {"plans", samples.size()},
                 {"total", percentiles(totals)},
                 {"not_compute", percentiles(wires)},
                 {"stages", stages}});
  return object;
}

void print(const Json& result) {
  fmt::print("{} plans, launch file {}\n", result["plans"].get<std::size_t>(),
             result["launch"].get<std::string>());
  fmt::print("{:<22} {:>12} {:>12} {:>12} {:>12}\n", "[us]", "compute p50", "compute p99",
             "wire p50", "wire p99");
  const auto us = [](const Json& times, const char* key) { return times[key].get<double>(); };
  for (const auto& s : result["stages"]) {
    fmt::print("{:<22} {:12.1f} {:12.1f} {:12.1f} {:12.1f}\n", s["name"].get<std::string>(),
               us(s["compute"], "p50_us"), us(s["compute"], "p99_us"), us(s["wire"], "p50_us"),
               us(s["wire"], "p99_us"));
  }
  fmt::print("{:<22} p50 {:.1f} us, p99 {:.1f} us, of which not computing p50 {:.1f} us\n",
             "whole plan", us(result["total"], "p50_us"), us(result["total"], "p99_us"),
             us(result["not_compute"], "p50_us"));
}

/// The map server's parameters, and a made world if they name no map.
Result<std::vector<std::string>> launch_arguments(const BenchOptions& o,
                                                  const std::string& folder) {
  auto args = o.map.ros_args();
  const auto config = PlanningConfig::read(args);
  if (!config) return config.error();
  if (config->needs_world()) {
    const auto map = load_map(*config);
    if (!map) return map.error();
    args.overrides.push_back({"map_server", "map_file", folder + "/world.bt"});
    if (auto saved = map_server::save_voxels(map->raw.geometry, map->raw.occupied, map->raw.known,
                                             args.overrides.back().value);
        !saved) {
      return saved.error();
    }
  }
  std::vector<std::string> arguments{o.launch, "--log-dir", folder, "--ros-args"};
  // Stages take requests from one process alone: this one, not the navigator.
  arguments.insert(arguments.end(), {"-r", "navigator:plan_request:=bench/unheard_requests"});
  for (const auto& file : args.params_files) {
    arguments.insert(arguments.end(), {"--params-file", file});
  }
  for (const auto& p : args.overrides) {
    arguments.insert(arguments.end(), {"-p", p.node + ":" + p.name + ":=" + p.value});
  }
  return arguments;
}

Result<std::vector<PlanSample>> take_samples(PlanTimer& timer, runtime::Node& node, int count) {
  std::vector<PlanSample> samples;
  for (int failures = 0; samples.size() < std::size_t(count) + kWarmUp;) {
    auto sample = timer.once(kPlan_s);
    if (sample) {
      samples.push_back(*std::move(sample));
      node.spin_some(0.005);
    } else if (++failures > kMostFailures) {
      return sample.error();
    } else {
      node.spin_some(0.2);
    }
  }
  samples.erase(samples.begin(), samples.begin() + kWarmUp);
  return samples;
}

Result<std::vector<PlanSample>> measure(const BenchOptions& o) {
  const auto domain = private_domain();
  if (!domain) return domain.error();
  const auto folder = make_log_folder("bench_plan");
  if (!folder) return folder.error();
  const auto arguments = launch_arguments(o, *folder);
  if (!arguments) return arguments.error();
  auto options = runtime::ContextOptions::from_environment();
  options->domain = *domain;
  auto context = runtime::Context::create(*options);
  if (!context) return context.error();
  runtime::Node node(**context, "goshawk_bench");
  PlanTimer timer(node, o.start_map, o.goal_map, o.map.limits());
  auto launch = start_launch(*arguments, *domain, *folder + "/launch.log");
  if (!launch) return launch.error();
  const std::int64_t end_ns = node.now_ns() + std::int64_t(kStagesReady_s * 1e9);
  while (!timer.stages_ready() && node.now_ns() < end_ns) {
    if (launch->ended()) return launch->failure();
    node.spin_some(0.05);
  }
  if (!timer.stages_ready()) {
    return fail(ErrorCode::stage_silent,
                fmt::format("the stages did not report ready within {:g} s: see {}", kStagesReady_s,
                            *folder));
  }
  return take_samples(timer, node, o.count);
}

int run_bench_plan(const BenchOptions& o, const Console& console) {
  const auto samples = measure(o);
  if (!samples) return console.failed(samples.error());
  const Json result = result_json(*samples, o);
  console.json() ? console.print(result) : print(result);
  return kDone;
}

}  // namespace

void add_bench_plan(const Verb& bench) {
  const Verb verb =
      bench.word("plan", "latency of whole plans over DDS, by stage: computing, and on the wire");
  auto o = std::make_shared<BenchOptions>();
  add_map_options(verb, o->map);
  add_point(verb, "--start", o->start_map, "[m] frame map");
  add_point(verb, "--goal", o->goal_map, "[m] frame map");
  auto* launch =
      verb->add_option("--launch", o->launch, "flight (a process each) or flight_container (one)")
          ->capture_default_str();
  verb.completes(launch, launch_files);
  verb->add_option("-n,--count", o->count, "plans")
      ->capture_default_str()
      ->check(CLI::Range(1, 1'000'000));
  verb->footer(
      "Examples:\n"
      "  goshawk bench plan\n"
      "  goshawk bench plan --launch flight_container -n 1000 --json");
  verb.runs([o](const Console& console) { return run_bench_plan(*o, console); });
}

}  // namespace goshawk::cli
