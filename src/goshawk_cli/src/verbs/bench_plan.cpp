#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <functional>

#include "bench/plan_child.hpp"
#include "bench/plan_rig.hpp"
#include "values.hpp"
#include "verbs/bench.hpp"

namespace goshawk::cli {
namespace {

constexpr int kWarmUp = 10;  // plans that do not count

struct BenchOptions {
  PlanRigOptions rig;
  int count = 200;
};

/// Whom to ask for plans, and what came of it.
struct Asked {
  std::function<Result<PlanSample>()> sample;
  std::function<Result<double>()> processor_s;
  std::vector<PlanSample> samples;
  double processor_share = 0.0;  // of one core, by all processes of the flight
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

Json times_json(const Asked& asked) {
  std::vector<std::int64_t> totals;
  std::vector<std::int64_t> wires;
  for (const auto& s : asked.samples) {
    std::int64_t compute_ns = 0;
    for (const auto& [name, times] : s.stages) compute_ns += times.compute_ns;
    totals.push_back(s.total_ns);
    wires.push_back(s.total_ns - compute_ns);
  }
  Json stages = Json::array();
  for (const char* name : kPlanningStages) stages.push_back(stage_json(asked.samples, name));
  stages.push_back(stage_json(asked.samples, "reply"));
  return {{"plans", asked.samples.size()},
          {"total", percentiles(totals)},
          {"not_compute", percentiles(wires)},
          {"stages", stages},
          {"processor_share", asked.processor_share}};
}

/// @param secured nothing: not asked for
Json result_json(const Asked& plain, const std::optional<Asked>& secured, const BenchOptions& o) {
  Json object = ok_json();
  object["launch"] = o.rig.launch;
  object.update(times_json(plain));
  object["secured"] = secured ? times_json(*secured) : Json(nullptr);
  return object;
}

void print_times(const Json& result) {
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
  fmt::print("{:<22} {:.1f} % of a core\n", "all processes",
             100.0 * result["processor_share"].get<double>());
}

void print(const Json& result) {
  fmt::print("{} plans, launch file {}\n", result["plans"].get<std::size_t>(),
             result["launch"].get<std::string>());
  print_times(result);
  if (result["secured"].is_null()) return;
  fmt::print("\nwith DDS Security, in turns with the others\n");
  print_times(result["secured"]);
}

Status ask_each(std::vector<Asked*>& all, int count) {
  for (int k = 0; k < count; ++k) {
    for (Asked* asked : all) {
      auto sample = asked->sample();
      if (!sample) return sample.error();
      asked->samples.push_back(*std::move(sample));
    }
  }
  return success();
}

/// Takes the sum of what began and ended.
Status count_processor(std::vector<Asked*>& all, double sign) {
  for (Asked* asked : all) {
    const auto used_s = asked->processor_s();
    if (!used_s) return used_s.error();
    asked->processor_share += sign * *used_s;
  }
  return success();
}

/// In turns, so that what else the machine does strikes all alike.
Status measure(std::vector<Asked*> all, int count) {
  if (auto status = ask_each(all, kWarmUp); !status) return status;
  for (Asked* asked : all) asked->samples.clear();
  const auto begin = std::chrono::steady_clock::now();
  if (auto status = count_processor(all, -1.0); !status) return status;
  if (auto status = ask_each(all, count); !status) return status;
  if (auto status = count_processor(all, 1.0); !status) return status;
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - begin;
  for (Asked* asked : all) asked->processor_share /= took.count();
  return success();
}

template <typename Rig>
Asked ask(Rig& rig) {
  return {.sample = [&rig] { return rig.sample(); },
          .processor_s = [&rig] { return Result<double>(rig.processor_s()); },
          .samples = {}};
}

Result<Json> run(const BenchOptions& o) {
  std::optional<PlanChild> secured_rig;
  if (!o.rig.secure.empty()) {
    auto child = PlanChild::start(o.rig);
    if (!child) return child.error();
    secured_rig.emplace(*std::move(child));
    unsetenv("FASTRTPS_DEFAULT_PROFILES_FILE");  // it may name a certificate
  }
  auto plain_options = o.rig;
  plain_options.secure.clear();
  const auto rig = PlanRig::start(plain_options);
  if (!rig) return rig.error();
  Asked plain = ask(**rig);
  std::optional<Asked> secured;
  std::vector<Asked*> all{&plain};
  if (secured_rig) {
    if (auto status = secured_rig->ready(); !status) return status.error();
    secured = ask(*secured_rig);
    all.push_back(&*secured);
  }
  if (auto status = measure(all, o.count); !status) return status.error();
  return result_json(plain, secured, o);
}

int run_bench_plan(const BenchOptions& o, const Console& console) {
  const auto result = run(o);
  if (!result) return console.failed(result.error());
  console.json() ? console.print(*result) : print(*result);
  return kDone;
}

}  // namespace

void add_bench_plan(const Verb& bench) {
  const Verb verb =
      bench.word("plan", "latency of whole plans over DDS, by stage: computing, and on the wire");
  auto o = std::make_shared<BenchOptions>();
  add_map_options(verb, o->rig.map);
  add_point(verb, "--start", o->rig.start_map, "[m] frame map");
  add_point(verb, "--goal", o->rig.goal_map, "[m] frame map");
  auto* launch = verb->add_option("--launch", o->rig.launch,
                                  "flight (a process each) or flight_container (one)")
                     ->capture_default_str();
  verb.completes(launch, launch_files);
  verb->add_option("--secure", o->rig.secure,
                   "folder of goshawk secure init: also ask stages with DDS Security, in turns");
  verb->add_option("-n,--count", o->count, "plans")
      ->capture_default_str()
      ->check(CLI::Range(1, 1'000'000));
  verb->footer(
      "Examples:\n"
      "  goshawk bench plan\n"
      "  goshawk bench plan --secure keys\n"
      "  goshawk bench plan --launch flight_container -n 1000 --json");
  verb.runs([o](const Console& console) { return run_bench_plan(*o, console); });
}

}  // namespace goshawk::cli
