// goshawk bench scenario MAP.3dmap SCEN.3dscen: do our lengths match the published ones, and how
// long does a problem take?
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "common/call.hpp"
#include "common/measure.hpp"
#include "goshawk/path_search/planner.hpp"
#include "search/warframe_files.hpp"

namespace goshawk::bench {
namespace {

using Json = nlohmann::ordered_json;
using worlds::Problem;

struct ScenarioOptions {
  std::string map;
  std::string scenario;
  int limit = 0;
  std::vector<std::string> planners;
  bool json = false;
};

/// The files give eight decimals.
bool matches(double length, double published) {
  return std::abs(length - published) <= 1e-7 + 1e-8 * published;
}

Result<Json> run_planner(const std::string& name, const BitGrid& map,
                         const std::vector<Problem>& problems) {
  path_search::Config config;
  const auto chosen = from_word<path_search::Planner>(name);
  if (!chosen) {
    return fail(ErrorCode::invalid_parameter,
                fmt::format("planner is '{}' and must be one of {}", name,
                            fmt::join(all_words<path_search::Planner>(), ", ")));
  }
  config.planner = *chosen;
  auto planner = path_search::make_planner(config);
  if (!planner) return planner.error();
  (*planner)->set_map(map);
  path_search::VoxelPath path;
  std::vector<double> us;
  std::int64_t mismatches = 0;
  double expanded = 0.0;
  for (std::size_t k = 0; k < problems.size(); ++k) {
    const auto begin = std::chrono::steady_clock::now();
    const auto status = (*planner)->search(problems[k].start, problems[k].goal, path);
    const std::chrono::duration<double> took = std::chrono::steady_clock::now() - begin;
    us.push_back(1e6 * took.count());
    expanded += double(path.counters.expanded);
    if (status && matches(path.cost_voxels, problems[k].length_voxels)) continue;
    if (++mismatches > 3) continue;
    std::fprintf(stderr, "%s, problem %zu: %s\n", name.c_str(), k + 1,
                 status ? ("length " + std::to_string(path.cost_voxels) + ", published " +
                           std::to_string(problems[k].length_voxels))
                              .c_str()
                        : status.error().message.c_str());
  }
  return Json{{"planner", name},
              {"problems", problems.size()},
              {"mismatches", mismatches},
              {"median_us", median(us)},
              {"mean_expanded", expanded / double(problems.size())}};
}

int fail_with(const Error& error, bool json) {
  return report_failure("scenario", json, error);
}

int run(const ScenarioOptions& o) {
  const auto map = worlds::read_voxel_map(o.map);
  if (!map) return fail_with(map.error(), o.json);
  auto problems = worlds::read_scenario(o.scenario);
  if (!problems) return fail_with(problems.error(), o.json);
  if (o.limit > 0 && std::size_t(o.limit) < problems->size())
    problems->resize(std::size_t(o.limit));
  Json rows = Json::array();
  std::int64_t mismatches = 0;
  for (const std::string& name : o.planners) {
    const auto row = run_planner(name, *map, *problems);
    if (!row) return fail_with(row.error(), o.json);
    mismatches += (*row)["mismatches"].get<std::int64_t>();
    rows.push_back(*row);
    if (o.json) continue;
    std::printf("%-16s %lld problems, %lld mismatches, median %.1f us, %.0f nodes\n", name.c_str(),
                (*row)["problems"].get<long long>(), (*row)["mismatches"].get<long long>(),
                (*row)["median_us"].get<double>(), (*row)["mean_expanded"].get<double>());
  }
  if (o.json) {
    const Json object{{"bench", "scenario"},
                      {"map", o.map},
                      {"scenario", o.scenario},
                      {"rule", "no_squeeze"},
                      {"problems", problems->size()},
                      {"mismatches", mismatches},
                      {"median_us", rows[0]["median_us"]},
                      {"rows", rows}};
    std::printf("%s\n", object.dump(1, ' ', false, Json::error_handler_t::replace).c_str());
  }
  return mismatches == 0 ? 0 : 1;
}

}  // namespace
}  // namespace goshawk::bench

int main(int argc, char** argv) {
  using namespace goshawk::bench;
  return bench_call(argc, argv, "scenario", [](const Call& call) {
    return run({.map = call.at("map"),
                .scenario = call.at("scenario"),
                .limit = call.at("limit"),
                .planners = call.at("planners"),
                .json = call.at("json")});
  });
}
