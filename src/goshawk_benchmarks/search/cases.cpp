#include "search/cases.hpp"

#include <algorithm>
#include <ctime>
#include <fstream>
#include <memory>
#include <numeric>
#include <stdexcept>

#include "common/measure.hpp"
#include "goshawk/core/random.hpp"
#include "goshawk/path_search/path_search.hpp"
#include "search/plain_astar.hpp"

namespace goshawk::bench {
namespace {

using path_search::Config;
using path_search::CornerRule;
using path_search::GridPlanner;
using path_search::VoxelPath;
using worlds::World;
using Json = nlohmann::ordered_json;

constexpr const char* kPlain = "plain_astar";

// Of the processor: other programs may take their turns.
double seconds(const std::function<void()>& run) {
  const auto now_s = [] {
    timespec t{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
    return double(t.tv_sec) + 1e-9 * double(t.tv_nsec);
  };
  const double begin_s = now_s();
  run();
  return now_s() - begin_s;
}

Json or_null(std::optional<double> value) {
  return value ? Json(*value) : Json(nullptr);
}

std::unique_ptr<GridPlanner> planner_of(const std::string& name, const std::string& rule) {
  Config config;
  config.planner = from_word<path_search::Planner>(name).value();
  config.corner_rule = from_word<path_search::CornerRule>(rule).value();
  return std::move(path_search::make_planner(config)).value();
}

/// What one planner did on all queries.
struct Samples {
  std::vector<double> us, expanded, setup_us;
  double length_voxels = 0.0;
};

/// One planner on one world.
struct Runner {
  std::string name;
  std::unique_ptr<GridPlanner> planner;  // none: the plain baseline
  VoxelPath path;
  double length = 0.0;

  void run(const World& world, const World::Query& q, const std::string& rule) {
    if (planner) {
      if (auto status = planner->search(q.start, q.goal, path); !status) {
        throw std::runtime_error(name + " on " + world.name + ": " + status.error().message);
      }
      length = path.cost_voxels;
    } else {
      length = plain_astar(world.blocked, q.start, q.goal,
                           rule == "squeeze" ? CornerRule::squeeze : CornerRule::no_squeeze);
    }
  }
};

// The slow ones apart: between two turns they would empty the caches of the fast ones.
bool is_slow(const std::string& planner) {
  return planner == kPlain || planner == "dijkstra";
}

void measure_query(const Case& c, const World& world, const World::Query& q,
                   std::vector<Runner>& runners, std::vector<Samples>& samples) {
  for (const bool slow : {false, true}) {
    std::vector<Contender> contenders;
    std::vector<std::size_t> which;
    double round_s = 0.0;
    for (std::size_t k = 0; k < runners.size(); ++k) {
      if (is_slow(runners[k].name) != slow) continue;
      contenders.push_back({runners[k].name, [&, k] { runners[k].run(world, q, c.rule); }});
      which.push_back(k);
      round_s += seconds(contenders.back().run);
    }
    if (contenders.empty()) continue;
    const int rounds = int(std::clamp(c.seconds_a_query / round_s, 1.0, 15.0));
    const auto timings = compare(world.name, contenders, rounds, Clock::processor);
    for (std::size_t i = 0; i < which.size(); ++i) {
      Samples& s = samples[which[i]];
      s.us.push_back(timings[i].median_us());
      s.expanded.push_back(double(runners[which[i]].path.counters.expanded));
      s.length_voxels += runners[which[i]].length;
    }
  }
}

double share_of(std::vector<double> values, double share) {
  std::ranges::sort(values);
  return at_share(values, share);
}

Json row_of(const Case& c, std::size_t k, const Samples& s) {
  const bool plain = c.planners[k] == kPlain;
  Json row{{"table", c.table},
           {"map", c.map},
           {"ratio", or_null(c.ratio)},
           {"label", c.label()},
           {"planner", c.planners[k]},
           {"rule", c.rule},
           {"maps", c.worlds.size()},
           {"queries", s.us.size()},
           {"median_us", median(s.us)},
           {"p90_us", share_of(s.us, 0.9)},
           {"sum_us", std::accumulate(s.us.begin(), s.us.end(), 0.0)},
           {"expanded", plain ? Json(nullptr) : Json(median(s.expanded))},
           {"length_m", s.length_voxels * c.resolution_m / double(s.us.size())},
           {"setup_us", plain ? Json(nullptr) : Json(median(s.setup_us))},
           {"voxels", c.worlds.front().blocked.voxels()}};
  if (c.thesis.empty()) return row;
  const auto& t = c.thesis[k];
  row["thesis_us"] = t ? Json(1e3 * t->time_ms) : Json(nullptr);
  row["thesis_nodes"] = t ? Json(t->nodes) : Json(nullptr);
  row["thesis_length_m"] = t ? Json(t->length_m) : Json(nullptr);
  return row;
}

std::size_t resident_bytes() {
  std::ifstream in("/proc/self/statm");
  std::size_t pages = 0, resident = 0;
  in >> pages >> resident;
  return resident * 4096;
}

std::shared_ptr<VoxelGrid> grid_of(const World& world, double resolution_m) {
  auto grid = std::make_shared<VoxelGrid>();
  grid->geometry = {Vec3::Zero(), resolution_m, world.blocked.size()};
  grid->grown = world.blocked;
  return grid;
}

path_search::PathSearch stage_of(const Case& c, const std::string& planner,
                                 const std::string& pruning) {
  // "rrt, fcl" is rrt with that validity.
  const std::size_t comma = planner.find(',');
  Config config;
  config.planner = from_word<path_search::Planner>(planner.substr(0, comma)).value();
  if (comma != std::string::npos) config.validity = path_search::Validity::fcl;
  config.corner_rule = from_word<path_search::CornerRule>(c.rule).value();
  config.pruning = from_word<path_search::Pruning>(pruning).value();
  config.max_iterations = 3000;
  return std::move(path_search::PathSearch::create(config)).value();
}

// Random obstacles may cut a goal off: such queries say nothing about paths.
void keep_joined(Case& c) {
  const auto planner = planner_of("jastar", c.rule);
  for (World& world : c.worlds) {
    planner->set_map(world.blocked);
    std::erase_if(world.queries,
                  [&](const World::Query& q) { return !planner->search(q.start, q.goal).ok(); });
  }
  std::erase_if(c.worlds, [](const World& world) { return world.queries.empty(); });
}

}  // namespace

void measure(Report& report, Case c) {
  keep_joined(c);
  if (c.worlds.empty()) {
    report.progress(c.map + " is left out: no query is left, or no map (set GOSHAWK_DATA)");
    return;
  }
  report.progress(c.table + ", " + c.map + ", " + c.rule);
  std::vector<Samples> samples(c.planners.size());
  for (const World& world : c.worlds) {
    std::vector<Runner> runners(c.planners.size());
    for (std::size_t k = 0; k < runners.size(); ++k) {
      runners[k].name = c.planners[k];
      if (c.planners[k] == kPlain) continue;
      samples[k].setup_us.push_back(1e6 * seconds([&] {
                                      runners[k].planner = planner_of(c.planners[k], c.rule);
                                      runners[k].planner->set_map(world.blocked);
                                    }));
    }
    for (const World::Query& q : world.queries) measure_query(c, world, q, runners, samples);
  }
  for (std::size_t k = 0; k < samples.size(); ++k) report.add(row_of(c, k, samples[k]));
}

void measure_sampling(Report& report, Case c) {
  keep_joined(c);
  report.progress(c.table + ", " + c.map);
  for (const std::string& planner : c.planners) {
    std::vector<double> us, expanded, setup_us;
    double length_m = 0.0;
    for (const World& world : c.worlds) {
      const auto grid = grid_of(world, c.resolution_m);
      auto search = stage_of(c, planner, "shortest");
      setup_us.push_back(1e6 * seconds([&] { search.set_map(grid); }));
      const World::Query& q = world.queries.front();
      const Vec3 start = grid->geometry.center(q.start), goal = grid->geometry.center(q.goal);
      path_search::PlannedPath path;
      bool found = false;
      const auto plan = [&] { found = search.plan(start, goal, path).ok(); };
      const auto timing =
          compare(world.name, {{planner, plan}}, planner == "jastar" ? 9 : 1, Clock::processor);
      if (!found) continue;
      us.push_back(timing[0].median_us());
      expanded.push_back(double(path.counters.expanded));
      length_m += path.pruned_length_m;
    }
    Json row{{"table", c.table},   {"map", c.map},   {"ratio", or_null(c.ratio)},
             {"planner", planner}, {"rule", c.rule}, {"maps", c.worlds.size()},
             {"found", us.size()}};
    row["median_us"] = us.empty() ? Json(nullptr) : Json(median(us));
    row["expanded"] = us.empty() ? Json(nullptr) : Json(median(expanded));
    row["length_m"] = us.empty() ? Json(nullptr) : Json(length_m / double(us.size()));
    row["setup_us"] = median(setup_us);
    report.add(row);
  }
}

void measure_setup(Report& report, Case c) {
  keep_joined(c);
  if (c.worlds.empty()) return;
  report.progress(c.table + ", " + c.map);
  const World& world = c.worlds.front();
  BitGrid map = world.blocked;
  Random random(1);
  const std::size_t before = resident_bytes();
  auto planner = planner_of("jastar", c.rule);
  planner->set_map(map);
  VoxelPath path;
  const auto& q = world.queries.front();
  const auto query = [&] { (void)planner->search(q.start, q.goal, path).ok(); };
  query();
  const std::size_t after = resident_bytes();
  const double bytes = after > before ? double(after - before) : 0.0;
  const auto change = [&] {
    for (int k = 0; k < 1000; ++k) {
      const Index3 at{random.below(map.size().x), random.below(map.size().y),
                      random.below(map.size().z)};
      if (!(at == q.start) && !(at == q.goal)) map.set(at, !map.get(at));
    }
  };
  std::vector<double> fresh, same, changed, queries;
  for (int n = 0; n < 7; ++n) {
    std::unique_ptr<GridPlanner> other;
    fresh.push_back(1e6 * seconds([&] {
                      other = planner_of("jastar", c.rule);
                      other->set_map(map);
                    }));
    same.push_back(1e6 * seconds([&] { planner->set_map(map); }));
    queries.push_back(1e6 * seconds(query));
    change();
    changed.push_back(1e6 * seconds([&] { planner->set_map(map); }));
  }
  report.add({{"table", c.table},
              {"map", c.map},
              {"ratio", or_null(c.ratio)},
              {"planner", "jastar"},
              {"rule", c.rule},
              {"maps", 1},
              {"voxels", map.voxels()},
              {"expanded", path.counters.expanded},
              {"length_m", path.cost_voxels * c.resolution_m},
              {"setup_us", median(fresh)},
              {"same_map_us", median(same)},
              {"changed_1000_us", median(changed)},
              {"median_us", median(queries)},
              {"bytes_a_voxel", bytes / double(map.voxels())}});
}

void measure_pruning(Report& report, Case c) {
  keep_joined(c);
  report.progress(c.table + ", " + c.map);
  for (const std::string pruning : {"none", "greedy", "shortest", "relaxed"}) {
    std::vector<double> us, waypoints, expanded, setup_us;
    double length_m = 0.0;
    for (const World& world : c.worlds) {
      const auto grid = grid_of(world, c.resolution_m);
      auto search = stage_of(c, "jastar", pruning);
      setup_us.push_back(1e6 * seconds([&] { search.set_map(grid); }));
      const World::Query& q = world.queries.front();
      const Vec3 start = grid->geometry.center(q.start), goal = grid->geometry.center(q.goal);
      path_search::PlannedPath path;
      const auto plan = [&] { (void)search.plan(start, goal, path).ok(); };
      us.push_back(compare(world.name, {{pruning, plan}}, 9, Clock::processor)[0].median_us());
      waypoints.push_back(double(path.waypoints_map.size()));
      expanded.push_back(double(path.counters.expanded));
      length_m += path.pruned_length_m;
    }
    report.add({{"table", c.table},
                {"map", c.map},
                {"ratio", or_null(c.ratio)},
                {"planner", "jastar, pruning " + pruning},
                {"rule", c.rule},
                {"maps", c.worlds.size()},
                {"median_us", median(us)},
                {"waypoints", median(waypoints)},
                {"expanded", median(expanded)},
                {"length_m", length_m / double(c.worlds.size())},
                {"setup_us", median(setup_us)}});
  }
}

}  // namespace goshawk::bench
