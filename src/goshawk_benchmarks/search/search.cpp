// goshawk bench search: the thesis' tables 1 and 2, structured, big and real maps, growth with the
// size of the map, sampling planners, pruning, what a map costs to take over; and the hard cases:
// long detours, no way, random queries in a big map, the first query, replanning.
#include <cmath>

#include "goshawk/core/random.hpp"
#include "search/cases.hpp"

namespace goshawk::bench {
namespace {

using worlds::World;
using Seeded = World (*)(Index3, double, std::uint64_t);

const std::vector<std::string> kRules = {"squeeze", "no_squeeze"};

std::vector<World> seeds(int count, Seeded make, Index3 size, double ratio) {
  std::vector<World> all;
  for (int seed = 1; seed <= count; ++seed) all.push_back(make(size, ratio, std::uint64_t(seed)));
  return all;
}

// Between free voxels anywhere; goals that cannot be reached are left out later.
World with_random_queries(World world, int count) {
  Random random(7);
  const Index3 size = world.blocked.size();
  const auto any = [&] {
    Index3 at;
    do at = {random.below(size.x), random.below(size.y), random.below(size.z)};
    while (world.blocked.get(at));
    return at;
  };
  world.queries.clear();
  for (int k = 0; k < count; ++k) {
    const Index3 start = any();
    world.queries.push_back({start, any()});
  }
  return world;
}

void thesis_table_1(Report& report, int maps) {
  struct Size {
    const char* name;
    Index3 voxels;
    std::vector<std::optional<ThesisFigures>> thesis;
  };
  const Size sizes[] = {
      {"5x5x5 m",
       {25, 25, 25},
       {{{.555, 464, 4.579}}, {{2.5, 1557, 4.498}}, {{2.074, 1361, 4.498}}}},
      {"10x10x5 m",
       {50, 50, 25},
       {{{.584, 545, 9.102}}, {{9.033, 3709, 9.068}}, {{2.949, 1424, 9.068}}}},
      {"20x20x5 m",
       {100, 100, 25},
       {{{124.37, 4937, 15.56}}, {{193.18, 14599, 15.446}}, {{134.7, 8783, 15.446}}}}};
  for (const Size& s : sizes) {
    measure(report, {.table = "thesis 1",
                     .map = "noise " + std::string(s.name),
                     .ratio = 0.4,
                     .rule = "squeeze",
                     .worlds = seeds(maps, worlds::noise, s.voxels, 0.4),
                     .planners = {"astar_manhattan", "astar_euclidean", "astar"},
                     .thesis = s.thesis});
  }
  report.draw({.file = "thesis_1",
               .title = "A* and its heuristics, independent voxels at 0.4",
               .x = "voxels",
               .y = "median_us",
               .x_label = "voxels of the map",
               .y_label = "time of a query [us]",
               .series = "planner",
               .where = {{"table", "thesis 1"}},
               .log_x = true,
               .log_y = true});
}

void thesis_table_2(Report& report, int maps) {
  using Thesis = std::vector<std::optional<ThesisFigures>>;
  const std::pair<double, Thesis> ratios[] = {
      {0.1, {{{385.681, 56329, 8.239}}, {{.303, 483, 8.239}}, {{.321, 145, 8.239}}, {}}},
      {0.2, {{{293.062, 49624, 8.44}}, {{1.113, 801, 8.44}}, {{.387, 334, 8.44}}, {}}},
      {0.4, {{{135.271, 37893, 9.068}}, {{2.949, 1424, 9.068}}, {{.51, 575, 9.068}}, {}}}};
  for (const std::string& rule : kRules) {
    const std::string table = rule == "squeeze" ? "thesis 2" : "thesis 2, no_squeeze";
    for (const auto& [ratio, thesis] : ratios) {
      measure(report, {.table = table,
                       .map = "noise 10x10x5 m",
                       .ratio = ratio,
                       .rule = rule,
                       .worlds = seeds(maps, worlds::noise, {50, 50, 25}, ratio),
                       .planners = {"dijkstra", "astar", "jastar", "plain_astar"},
                       .thesis = thesis,
                       .seconds_a_query = 0.03});
    }
    report.draw({.file = rule == "squeeze" ? "thesis_2" : "thesis_2_no_squeeze",
                 .title = "10x10x5 m at 0.2 m, independent voxels, " + rule,
                 .x = "ratio",
                 .y = "median_us",
                 .x_label = "share of voxels that are occupied",
                 .y_label = "time of a query [us]",
                 .series = "planner",
                 .where = {{"table", table}},
                 .log_y = true});
  }
}

void structured(Report& report, bool quick) {
  const int maps = quick ? 2 : 8;
  const std::vector<std::string> planners = {"jastar", "astar", "plain_astar"};
  const auto row = [&](const std::string& map, std::optional<double> ratio, const std::string& rule,
                       std::vector<World> all) {
    measure(report, {.table = "structured",
                     .map = map,
                     .ratio = ratio,
                     .rule = rule,
                     .worlds = std::move(all),
                     .planners = planners});
  };
  for (const std::string& rule : kRules) {
    for (const double ratio : {0.1, 0.2, 0.4}) {
      row("boxes 20x20x5 m", ratio, rule, seeds(maps, worlds::boxes, {100, 100, 25}, ratio));
    }
    row("forest 20x20x5 m", 0.2, rule, seeds(maps, worlds::forest, {100, 100, 25}, 0.2));
    std::vector<World> offices;
    for (int seed = 1; seed <= (quick ? 1 : 4); ++seed) {
      offices.push_back(worlds::office({200, 200, 15}, std::uint64_t(seed)));
    }
    row("office 40x40x3 m", {}, rule, std::move(offices));
    for (const double ratio : {0.02, 0.05}) {
      row("noise 20x20x5 m", ratio, rule, seeds(maps, worlds::noise, {100, 100, 25}, ratio));
    }
  }
}

void real(Report& report, bool quick) {
  const std::size_t queries = quick ? 5 : 40;
  for (const std::string& rule : kRules) {
    for (const char* name : {"geb079.bt", "fr78.bt"}) {
      measure(report, {.table = "real",
                       .map = name,
                       .rule = rule,
                       .resolution_m = name[0] == 'g' ? 0.1 : 0.05,
                       .worlds = {worlds::octomap(name, queries)},
                       .planners = {"jastar", "astar", "plain_astar"},
                       .seconds_a_query = quick ? 0.02 : 0.05});
    }
    for (const char* name : {"Simple", "Complex"}) {
      measure(report, {.table = "real",
                       .map = "warframe " + std::string(name),
                       .rule = rule,
                       .resolution_m = 1.0,
                       .worlds = {worlds::warframe(name, queries)},
                       .planners = {"jastar", "astar", "plain_astar"},
                       .seconds_a_query = quick ? 0.02 : 0.05});
    }
  }
}

void big(Report& report, bool quick) {
  const Index3 size{500, 500, 50};
  for (const std::string& rule : kRules) {
    if (quick && rule == "squeeze") continue;
    const auto row = [&](const char* map, double ratio, Seeded make) {
      measure(report, {.table = "big",
                       .map = map,
                       .ratio = ratio,
                       .rule = rule,
                       .worlds = seeds(quick ? 1 : 3, make, size, ratio),
                       .planners = quick ? std::vector<std::string>{"jastar"}
                                         : std::vector<std::string>{"jastar", "astar"},
                       .seconds_a_query = quick ? 0.1 : 1.0});
    };
    row("boxes 100x100x10 m", 0.2, worlds::boxes);
    if (quick) continue;
    row("boxes 100x100x10 m", 0.1, worlds::boxes);
    row("boxes 100x100x10 m", 0.4, worlds::boxes);
    row("noise 100x100x10 m", 0.02, worlds::noise);
  }
}

void first_queries(Report& report, const std::string& rule, bool quick) {
  const int maps = quick ? 3 : 12;
  Case first{.table = "first query", .rule = rule};
  first.map = "noise 10x10x5 m";
  first.ratio = 0.1;
  first.worlds = seeds(maps, worlds::noise, {50, 50, 25}, 0.1);
  measure_first(report, first);
  first.map = "boxes 20x20x5 m";
  first.ratio = 0.2;
  first.worlds = seeds(maps, worlds::boxes, {100, 100, 25}, 0.2);
  measure_first(report, first);
  first.map = "warframe Complex, longest detours";
  first.ratio = {};
  first.worlds = {worlds::warframe_hard("Complex", std::size_t(maps))};
  if (!first.worlds.front().queries.empty()) measure_first(report, first);
}

// Where a search has most to do, or least to go by.
void hard(Report& report, bool quick) {
  const Index3 size{500, 500, 50};
  for (const std::string& rule : kRules) {
    measure(report, {.table = "hard",
                     .map = "warframe Complex, longest detours",
                     .rule = rule,
                     .resolution_m = 1.0,
                     .worlds = {worlds::warframe_hard("Complex", quick ? 20 : 100)},
                     .planners = {"jastar", "astar"},
                     .seconds_a_query = quick ? 0.02 : 0.05});
    Case no_way{.table = "no way",
                .map = "boxes 100x100x10 m, a wall",
                .ratio = 0.2,
                .rule = rule,
                .worlds = {worlds::walled(worlds::boxes(size, 0.2, 1))}};
    measure_no_way(report, no_way);
    no_way.map = "boxes 100x100x10 m, a closed room";
    no_way.worlds = {worlds::with_closed_room(worlds::boxes(size, 0.2, 1))};
    measure_no_way(report, no_way);
    if (!quick) {
      no_way.map = "boxes 200x200x20 m, a wall";
      no_way.worlds = {worlds::walled(worlds::boxes({1000, 1000, 100}, 0.2, 1))};
      measure_no_way(report, no_way);
    }
    Case any{.table = "random queries",
             .map = "boxes 100x100x10 m",
             .ratio = 0.2,
             .rule = rule,
             .worlds = {with_random_queries(worlds::boxes(size, 0.2, 1), quick ? 10 : 40)},
             .planners = {"jastar"},
             .seconds_a_query = quick ? 0.02 : 0.1};
    measure(report, any);
    any.table = "first query";
    any.worlds.front().queries.resize(quick ? 3 : 10);
    measure_first(report, any);
    first_queries(report, rule, quick);
    any.table = "replanning";
    any.worlds = seeds(quick ? 1 : 3, worlds::boxes, size, 0.2);
    for (const bool boxes : {true, false}) measure_replanning(report, any, boxes);
  }
}

/// Slope of log time over log voxels, least squares.
double exponent(const nlohmann::ordered_json& rows, const std::string& map,
                const std::string& planner) {
  double n = 0, sx = 0, sy = 0, sxx = 0, sxy = 0;
  for (const auto& row : rows) {
    if (row["table"] != "growth" || row["planner"] != planner || row["map"] != map) continue;
    const double x = std::log(row["voxels"].get<double>());
    const double y = std::log(row["median_us"].get<double>());
    n += 1, sx += x, sy += y, sxx += x * x, sxy += x * y;
  }
  return (n * sxy - sx * sy) / (n * sxx - sx * sx);
}

void growth(Report& report, bool quick) {
  const std::pair<std::string, std::pair<Seeded, double>> kinds[] = {
      {"boxes", {worlds::boxes, 0.2}}, {"noise", {worlds::noise, 0.4}}};
  for (const auto& [name, kind] : kinds) {
    for (const int edge : {40, 63, 100, 159, 252}) {
      if (quick && edge > 100) continue;
      measure(report,
              {.table = "growth",
               .map = name,
               .ratio = kind.second,
               .rule = "no_squeeze",
               .worlds = seeds(quick ? 3 : 7, kind.first, {edge, edge, edge / 4}, kind.second),
               .planners = {"jastar", "astar", "dijkstra"},
               .seconds_a_query = 0.02});
    }
    const auto rows = report.to_json()["rows"];
    for (const char* planner : {"jastar", "astar", "dijkstra"}) {
      report.note("exponent_" + name + "_" + planner, exponent(rows, name, planner));
    }
    report.draw({.file = "growth_" + name,
                 .title = "Growth with the map, " + name + ", no_squeeze",
                 .x = "voxels",
                 .y = "median_us",
                 .x_label = "voxels of the map",
                 .y_label = "time of a query [us]",
                 .series = "planner",
                 .where = {{"table", "growth"}, {"map", name}},
                 .log_x = true,
                 .log_y = true});
  }
}

void others(Report& report, bool quick) {
  const Case boxes{.table = "sampling",
                   .map = "boxes 10x10x5 m",
                   .ratio = 0.2,
                   .rule = "no_squeeze",
                   .worlds = seeds(quick ? 2 : 10, worlds::boxes, {50, 50, 25}, 0.2),
                   .planners = {"jastar", "rrt", "rrtstar", "prm", "rrt, fcl", "prm, fcl"}};
  measure_sampling(report, boxes);
  Case pruning = boxes;
  pruning.table = "pruning";
  measure_pruning(report, pruning);
  pruning.map = "noise 5x5x5 m";
  pruning.ratio = 0.1;
  pruning.worlds = seeds(quick ? 5 : 25, worlds::noise, {25, 25, 25}, 0.1);
  measure_pruning(report, pruning);
  measure_setup(report, {.table = "setup",
                         .map = "noise 0.4, 10x10x5 m",
                         .rule = "no_squeeze",
                         .worlds = seeds(1, worlds::noise, {50, 50, 25}, 0.4)});
  measure_setup(report, {.table = "setup",
                         .map = "boxes 0.2, 20x20x5 m",
                         .rule = "no_squeeze",
                         .worlds = seeds(1, worlds::boxes, {100, 100, 25}, 0.2)});
  measure_setup(report, {.table = "setup",
                         .map = "boxes 0.2, 100x100x10 m",
                         .rule = "no_squeeze",
                         .worlds = seeds(1, worlds::boxes, {500, 500, 50}, 0.2)});
}

void plots_of_classes(Report& report) {
  for (const std::string table : {"structured", "real", "big"}) {
    for (const std::string& rule : kRules) {
      report.draw({.file = rule == "squeeze" ? table + "_squeeze" : table,
                   .title = "Maps of the table \"" + table + "\", " + rule,
                   .x = "label",
                   .y = "median_us",
                   .x_label = "",
                   .y_label = "time of a query [us]",
                   .series = "planner",
                   .where = {{"table", table}, {"rule", rule}},
                   .log_y = true,
                   .points_only = true});
    }
  }
  report.draw({.file = "sampling",
               .title = "JA* beside planners that sample, 10x10x5 m, boxes at 0.2",
               .x = "median_us",
               .y = "length_m",
               .x_label = "time of a plan [us]",
               .y_label = "length after pruning [m]",
               .series = "planner",
               .where = {{"table", "sampling"}},
               .log_x = true,
               .points_only = true});
}

void run(Report& report) {
  const bool quick = report.options().quick;
  const int maps = quick ? 5 : 25;
  thesis_table_1(report, maps);
  thesis_table_2(report, maps);
  structured(report, quick);
  real(report, quick);
  big(report, quick);
  hard(report, quick);
  growth(report, quick);
  others(report, quick);
  plots_of_classes(report);
}

}  // namespace
}  // namespace goshawk::bench

int main(int argc, char** argv) {
  return goshawk::bench::bench_main(argc, argv, "search", goshawk::bench::run);
}
