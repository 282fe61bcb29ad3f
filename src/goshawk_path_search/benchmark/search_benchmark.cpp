// Time, nodes and length of each planner on each class of map, from one run, so that ratios hold:
//   search_benchmark [--benchmark_filter=boxes]
#include <benchmark/benchmark.h>

#include <algorithm>
#include <functional>

#include "goshawk/core/random.hpp"
#include "goshawk/path_search/planner.hpp"
#include "plain_astar.hpp"
#include "worlds.hpp"

namespace {

using goshawk::BitGrid;
using goshawk::Index3;
using goshawk::path_search::Config;
using goshawk::path_search::CornerRule;
using goshawk::path_search::GridPlanner;
using goshawk::path_search::make_planner;
using goshawk::path_search::VoxelPath;
using worlds::World;

struct Class {
  std::string name;
  std::function<std::vector<World>()> make;
  bool big = false;  // too slow for the plain baseline
};

// Worlds are made when first used and kept until the next class.
const std::vector<World>& worlds_of(const Class& c) {
  static std::string held_name;
  static std::vector<World> held;
  if (held_name != c.name) {
    held = c.make();
    held_name = c.name;
  }
  return held;
}

std::vector<Class> classes() {
  const auto seeds = [](int count, auto make) {
    return [count, make] {
      std::vector<World> all;
      for (int seed = 1; seed <= count; ++seed) all.push_back(make(std::uint64_t(seed)));
      return all;
    };
  };
  std::vector<Class> all;
  for (const double ratio : {0.1, 0.2, 0.4}) {
    all.push_back(
        {"noise/50x50x25/" + std::to_string(ratio).substr(0, 3), seeds(25, [ratio](auto s) {
           return worlds::noise({50, 50, 25}, ratio, s);
         })});
  }
  all.push_back({"noise/100x100x25/0.4", seeds(10, [](auto s) {
                   return worlds::noise({100, 100, 25}, 0.4, s);
                 })});
  for (const double ratio : {0.1, 0.2, 0.4}) {
    all.push_back(
        {"boxes/100x100x25/" + std::to_string(ratio).substr(0, 3), seeds(10, [ratio](auto s) {
           return worlds::boxes({100, 100, 25}, ratio, s);
         })});
  }
  all.push_back({"office/200x200x15", seeds(4, [](auto s) {
                   return worlds::office({200, 200, 15}, s);
                 })});
  all.push_back({"warframe/Simple", [] { return std::vector{worlds::warframe("Simple", 200)}; }});
  all.push_back({"warframe/Complex", [] { return std::vector{worlds::warframe("Complex", 200)}; }});
  all.push_back({"boxes/500x500x50/0.2",
                 seeds(2,
                       [](auto s) {
                         return worlds::boxes({500, 500, 50}, 0.2, s);
                       }),
                 true});
  all.push_back({"noise/500x500x50/0.02",
                 seeds(2,
                       [](auto s) {
                         return worlds::noise({500, 500, 50}, 0.02, s);
                       }),
                 true});
  return all;
}

// One iteration is all queries of all worlds of the class; counters are means of a query.
void run(benchmark::State& state, const Class& c, const std::string& planner,
         const std::string& rule) {
  const auto& all = worlds_of(c);
  Config config;
  config.planner = planner;
  config.corner_rule = rule;
  std::vector<std::unique_ptr<GridPlanner>> planners;
  double queries = 0.0;
  for (const World& world : all) {
    planners.push_back(std::move(make_planner(config)).value());
    planners.back()->set_map(world.blocked);
    queries += double(world.queries.size());
  }
  if (queries == 0.0) return state.SkipWithError("the map is not there: set GOSHAWK_DATA");
  VoxelPath path;
  double expanded = 0.0, length = 0.0;
  // The first query of a map also makes the pages of its labels: not what is measured here.
  for (std::size_t k = 0; k < all.size(); ++k) {
    for (const auto& q : all[k].queries) (void)planners[k]->search(q.start, q.goal, path).ok();
  }
  for (auto _ : state) {
    expanded = length = 0.0;
    for (std::size_t k = 0; k < all.size(); ++k) {
      for (const auto& q : all[k].queries) {
        benchmark::DoNotOptimize(planners[k]->search(q.start, q.goal, path).ok());
        expanded += double(path.counters.expanded);
        length += path.cost_voxels;
      }
    }
  }
  state.counters["us_per_query"] = benchmark::Counter(
      queries * 1e-6, benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
  state.counters["expanded"] = expanded / queries;
  state.counters["voxels"] = length / queries;
}

void run_plain(benchmark::State& state, const Class& c, CornerRule rule) {
  const auto& all = worlds_of(c);
  double queries = 0.0, length = 0.0;
  for (const World& world : all) queries += double(world.queries.size());
  if (queries == 0.0) return state.SkipWithError("the map is not there: set GOSHAWK_DATA");
  for (auto _ : state) {
    length = 0.0;
    for (const World& world : all) {
      for (const auto& q : world.queries) {
        length += std::max(0.0, plain_astar(world.blocked, q.start, q.goal, rule));
      }
    }
  }
  state.counters["us_per_query"] = benchmark::Counter(
      queries * 1e-6, benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
  state.counters["voxels"] = length / queries;
}

// What a new map, the same map, and one with 1,000 changed voxels cost.
void run_set_map(benchmark::State& state, const Class& c, int changes) {
  BitGrid map = worlds_of(c).front().blocked;
  const auto planner = std::move(make_planner(Config{})).value();
  planner->set_map(map);
  goshawk::Random random(1);
  for (auto _ : state) {
    if (changes < 0) {
      const auto fresh = std::move(make_planner(Config{})).value();
      fresh->set_map(map);
      continue;
    }
    for (int k = 0; k < changes; ++k) {
      const Index3 at{random.below(map.size().x), random.below(map.size().y),
                      random.below(map.size().z)};
      map.set(at, !map.get(at));
    }
    planner->set_map(map);
  }
}

}  // namespace

int main(int argc, char** argv) {
  const auto all = classes();
  for (const Class& c : all) {
    for (const std::string rule : {"squeeze", "no_squeeze"}) {
      for (const std::string planner : {"jastar", "astar", "dijkstra"}) {
        if (planner == "dijkstra" && c.big) continue;
        benchmark::RegisterBenchmark(
            (c.name + "/" + rule + "/" + planner).c_str(),
            [&c, planner, rule](benchmark::State& s) { run(s, c, planner, rule); })
            ->Unit(benchmark::kMillisecond);
      }
      if (c.big) continue;
      const auto corner = rule == "squeeze" ? CornerRule::squeeze : CornerRule::no_squeeze;
      benchmark::RegisterBenchmark((c.name + "/" + rule + "/plain").c_str(),
                                   [&c, corner](benchmark::State& s) { run_plain(s, c, corner); })
          ->Unit(benchmark::kMillisecond);
    }
    for (const auto& [what, changes] :
         {std::pair{"new", -1}, {"same", 0}, {"changed_1000", 1000}}) {
      benchmark::RegisterBenchmark((c.name + "/set_map/" + what).c_str(), [&c, n = changes](
                                                                              benchmark::State& s) {
        run_set_map(s, c, n);
      })->Unit(benchmark::kMillisecond);
    }
  }
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 1;
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}
