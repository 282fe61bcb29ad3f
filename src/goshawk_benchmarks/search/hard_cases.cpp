// Cases in which a search has most to do or least to go by: no way, a new map, a changed map.
#include <algorithm>
#include <stdexcept>

#include "common/measure.hpp"
#include "goshawk/core/random.hpp"
#include "goshawk/path_search/planner.hpp"
#include "goshawk/path_search/reachable.hpp"
#include "search/cases.hpp"

namespace goshawk::bench {
namespace {

using path_search::Config;
using path_search::CornerRule;
using path_search::GridPlanner;
using path_search::VoxelPath;
using worlds::World;
using Json = nlohmann::ordered_json;

constexpr int kChangedVoxels = 1000;

struct Search {
  explicit Search(const std::string& rule, bool reuse_path = false) {
    Config config;
    config.reuse_path = reuse_path;
    config.corner_rule = from_word<CornerRule>(rule).value();
    planner = std::move(path_search::make_planner(config)).value();
  }

  double map_us(const BitGrid& map) {
    return time_us([&] { planner->set_map(map); }, Clock::processor);
  }
  double query_us(const World::Query& q) {
    return time_us([&] { code = planner->search(q.start, q.goal, path).code(); }, Clock::processor);
  }

  std::unique_ptr<GridPlanner> planner;
  VoxelPath path;
  ErrorCode code = ErrorCode::ok;
};

/// Changes voxels anywhere in the map, none of which is an end of the query.
void change(BitGrid& map, const World::Query& q, Random& random) {
  for (int k = 0; k < kChangedVoxels; ++k) {
    const Index3 at{random.below(map.size().x), random.below(map.size().y),
                    random.below(map.size().z)};
    if (!(at == q.start) && !(at == q.goal)) map.set(at, !map.get(at));
  }
}

Json row_of(const Case& c, const std::string& what, std::vector<double> us, double expanded) {
  std::ranges::sort(us);
  return {{"table", c.table},
          {"map", c.map},
          {"ratio", c.ratio ? Json(*c.ratio) : Json(nullptr)},
          {"planner", what},
          {"rule", c.rule},
          {"queries", us.size()},
          {"median_us", at_share(us, 0.5)},
          {"p90_us", at_share(us, 0.9)},
          {"expanded", expanded},
          {"voxels", c.worlds.front().blocked.voxels()}};
}

}  // namespace

void measure_first(Report& report, const Case& c) {
  report.progress(c.table + ", " + c.map + ", " + c.rule);
  std::vector<double> map, first, again, ratio, expanded;
  for (const World& world : c.worlds) {
    for (const World::Query& q : world.queries) {
      Search search(c.rule);
      map.push_back(search.map_us(world.blocked));
      first.push_back(search.query_us(q));
      double best = search.query_us(q);
      for (int k = 0; k < 2; ++k) best = std::min(best, search.query_us(q));
      again.push_back(best);
      ratio.push_back(first.back() / best);
      expanded.push_back(double(search.path.counters.expanded));
    }
  }
  report.add(row_of(c, "jastar, a new map", map, 0.0));
  Json row = row_of(c, "jastar, first query", first, median(expanded));
  row["times_repeated"] = median(ratio);
  report.add(row);
  row = row_of(c, "jastar, the same again", again, median(expanded));
  row["times_repeated"] = 1.0;
  report.add(row);
}

void measure_no_way(Report& report, const Case& c) {
  report.progress(c.table + ", " + c.map + ", " + c.rule);
  std::vector<double> fresh, known, changed, flood;
  double expanded = 0.0, expanded_changed = 0.0;
  for (const World& world : c.worlds) {
    const World::Query& q = world.queries.front();
    BitGrid map = world.blocked;
    Random random(1);
    Search search(c.rule);
    (void)search.map_us(map);
    fresh.push_back(search.query_us(q));
    if (search.code != ErrorCode::no_path) throw std::runtime_error(c.map + ": there is a way");
    expanded = double(search.path.counters.expanded);
    for (int k = 0; k < 5; ++k) known.push_back(search.query_us(q));
    for (int k = 0; k < 5; ++k) {
      BitGrid next = map;
      change(next, q, random);
      world.cut_off(next);
      map = std::move(next);
      (void)search.map_us(map);
      changed.push_back(search.query_us(q));
      expanded_changed = double(search.path.counters.expanded);
    }
    const path_search::End goal = path_search::End::center_of(q.goal);
    flood.push_back(time_us(
        [&] {
          (void)path_search::nearest_reachable(
              map, from_word<CornerRule>(c.rule).value(),
              {.start = path_search::End::center_of(q.start), .goals = {&goal, 1}, .stop = {}});
        },
        Clock::processor));
  }
  report.add(row_of(c, "jastar, new map", fresh, expanded));
  report.add(row_of(c, "jastar, the same again", known, 0.0));
  report.add(row_of(c, "jastar, 1,000 voxels changed", changed, expanded_changed));
  report.add(row_of(c, "flood, voxel by voxel", flood, 0.0));
}

/// A box of 10 x 10 x 10 voxels appears somewhere, but for the ends of the query.
void block_a_box(BitGrid& map, const World::Query& q, Random& random) {
  const Index3 size = map.size();
  const Index3 lo{random.below(size.x - 10), random.below(size.y - 10), random.below(size.z - 10)};
  for (int z = lo.z; z < lo.z + 10; ++z) {
    for (int y = lo.y; y < lo.y + 10; ++y) map.set_run(lo.x, lo.x + 10, y, z, true);
  }
  map.set(q.start, false);
  map.set(q.goal, false);
}

// Two planners on the same maps, side by side: one searches again, one may keep its path.
void measure_replanning(Report& report, Case c, bool boxes) {
  const std::string after = boxes ? "a box appeared" : "1,000 voxels changed";
  report.progress(c.table + ", " + after + ", " + c.rule);
  std::vector<double> set_map, replan, reuse, expanded, expanded_reusing;
  for (World& world : c.worlds) {
    World::Query q = world.queries.front();
    BitGrid& map = world.blocked;
    Random random(1);
    Search search(c.rule), reusing(c.rule, true);
    for (Search* s : {&search, &reusing}) {
      (void)s->map_us(map);
      (void)s->query_us(q);
    }
    for (int k = 0; k < 10 && reusing.code == ErrorCode::ok; ++k) {
      q.start = reusing.path.cells[std::min<std::size_t>(3, reusing.path.cells.size() - 1)];
      boxes ? block_a_box(map, q, random) : change(map, q, random);
      set_map.push_back(search.map_us(map));
      replan.push_back(search.query_us(q));
      expanded.push_back(double(search.path.counters.expanded));
      (void)reusing.map_us(map);
      reuse.push_back(reusing.query_us(q));
      expanded_reusing.push_back(double(reusing.path.counters.expanded));
    }
  }
  report.add(row_of(c, "jastar, the map after " + after, set_map, 0.0));
  report.add(row_of(c, "jastar, search after " + after, replan, median(expanded)));
  report.add(row_of(c, "jastar, reuse_path, after " + after, reuse, median(expanded_reusing)));
}

}  // namespace goshawk::bench
