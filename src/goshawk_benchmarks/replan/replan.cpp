// goshawk bench replan: what it takes to plan again in flight, in a forest that unfolds.
#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <stdexcept>

#include "common/measure.hpp"
#include "common/report.hpp"
#include "goshawk/core/free_curve.hpp"
#include "goshawk/core/inflation.hpp"
#include "goshawk/core/stop_part.hpp"
#include "goshawk/corridor_builder/corridor_builder.hpp"
#include "goshawk/path_search/path_search.hpp"
#include "goshawk/trajectory_optimizer/trajectory_optimizer.hpp"
#include "goshawk/worlds/world.hpp"
#include "replan/scan_to_commit.hpp"

namespace goshawk::bench {
namespace {

constexpr double kResolution_m = 0.2, kInflation_m = 0.2;
const Vec3 kStart(1.1, 20.1, 2.1), kGoal(98.9, 20.1, 2.1);
constexpr Limits kLimits{.v_max_m_s = 5.0, .a_max_m_s2 = 10.0, .j_max_m_s3 = 60.0};

worlds::World forest(double density, std::uint64_t seed) {
  worlds::WorldSpec spec;
  spec.kind = "forest";
  spec.size_m = Vec3(100.0, 40.0, 6.0);
  spec.resolution_m = kResolution_m;
  spec.density = density;
  spec.seed = seed;
  spec.inflation_m = kInflation_m;
  spec.keep_free = {kStart, kGoal};
  auto world = worlds::make_world(spec);
  if (!world) throw std::runtime_error(world.error().message);
  return *std::move(world);
}

/// The map of a vehicle that has seen all within a range of where it was: of what lies behind
/// trunks too, so that the map is the fullest that there can be.
std::shared_ptr<const VoxelGrid> seen_from(const worlds::World& world, const Vec3& p_map,
                                           double range_m, std::uint64_t version) {
  const Index3 size = world.geometry.size;
  auto grid = std::make_shared<VoxelGrid>();
  grid->geometry = world.geometry;
  grid->known = BitGrid(size, false);
  grid->raw = BitGrid(size, true, false);
  grid->version = version;
  grid->inflation_m = kInflation_m;
  grid->unknown_is_occupied = false;
  const int end = std::clamp(int((p_map.x() + range_m) / kResolution_m), 0, size.x);
  for (int z = 0; z < size.z; ++z) {
    for (int y = 0; y < size.y; ++y) {
      grid->known.set_run(0, end, y, z, true);
      for (int x = 0; x < end; ++x) {
        if (world.occupied.get({x, y, z})) grid->raw.set({x, y, z}, true);
      }
    }
  }
  grid->grown = inflate(grid->raw, kInflation_m, kResolution_m).value();
  return grid;
}

/// The stages' cores, one after the other, in one thread.
class Planner {
 public:
  struct Times {
    double search_us, corridor_us, optimizer_us, stop_us;
    double all_us() const { return search_us + corridor_us + optimizer_us + stop_us; }
  };

  void set_map(const std::shared_ptr<const VoxelGrid>& map) {
    map_ = map;
    search_.set_map(map);
    space_.set_map(map);
  }

  /// @return what is to be flown, certified and checked against the map
  Result<CommittedTrajectory> plan(const PlanRequest& request, Times& times) {
    std::optional<Result<path_search::PlannedPath>> path;
    times.search_us = time_us([&] { path.emplace(search_.plan(request)); }, Clock::processor);
    if (!*path) return path->error();
    std::optional<Result<Corridor>> corridor;
    times.corridor_us = time_us(
        [&] { corridor.emplace(builder_.build(*map_, (*path)->waypoints_map)); }, Clock::processor);
    if (!*corridor) return corridor->error();
    std::optional<Result<trajectory_optimizer::Solution>> solution;
    times.optimizer_us = time_us(
        [&] { solution.emplace(optimizer_.optimise(request, **corridor)); }, Clock::processor);
    if (!*solution) return solution->error();
    std::optional<Result<CommittedTrajectory>> committed;
    times.stop_us =
        time_us([&] { committed.emplace(commit(request.id, std::move((*solution)->certified))); },
                Clock::processor);
    return *std::move(committed);
  }

 private:
  Result<CommittedTrajectory> commit(std::uint64_t id, CertifiedTrajectory nominal) {
    auto stop = latest_stop(nominal, space_, 0.0);
    if (!stop) return stop.error();
    auto committed = CommittedTrajectory::make({.id = id,
                                                .nominal = std::move(nominal),
                                                .stop = *std::move(stop),
                                                .map_version = map_->version});
    if (!committed) return committed;
    if (auto status = check_against(space_, *committed, 0.0); !status) return status.error();
    return committed;
  }

  std::shared_ptr<const VoxelGrid> map_;
  FreeSpace space_;
  path_search::PathSearch search_ = path_search::PathSearch::create({}).value();
  corridor_builder::CorridorBuilder builder_ =
      corridor_builder::CorridorBuilder::create({}).value();
  trajectory_optimizer::TrajectoryOptimizer optimizer_ =
      trajectory_optimizer::TrajectoryOptimizer::create({}).value();
};

struct Flight {
  std::vector<Planner::Times> times = {};
  int failed = 0;  // plans; what was flown before is then flown on
};

/// A flight through the forest, planned again every `step_s` from what is flown.
Flight fly(const worlds::World& world, double range_m, double step_s, int at_most) {
  Planner planner;
  Flight flight;
  std::optional<Trajectory> flown;
  double flown_s = 0.0;
  FlatState state{.position = kStart};
  for (std::uint64_t version = 1; int(version) <= at_most; ++version) {
    planner.set_map(seen_from(world, state.position, range_m, version));
    PlanRequest request;
    request.id = version;
    request.start = state;
    if (version > 1) request.start_time_ns = 1;
    request.goal.position = kGoal;
    request.limits = kLimits;
    request.unknown = UnknownSpace::free;
    Planner::Times times{};
    if (auto committed = planner.plan(request, times)) {
      flight.times.push_back(times);
      flown = committed->flown();
      flown_s = 0.0;
    } else {
      ++flight.failed;
    }
    flown_s += step_s;
    if (!flown || flown->duration_s() < flown_s) break;
    state = flown->sample(flown_s);
    if ((state.position - kGoal).norm() < 5.0) break;
  }
  return flight;
}

double share_ms(const std::vector<Planner::Times>& all, double share,
                double (*of)(const Planner::Times&)) {
  std::vector<double> sorted;
  for (const auto& times : all) sorted.push_back(of(times));
  std::ranges::sort(sorted);
  return at_share(sorted, share) * 1e-3;
}

// Over DDS: live flights in the default made world.
void fly_live_flights(Report& report) {
  for (const auto& [arrangement, launch] :
       {std::pair{"processes", "live"}, std::pair{"container", "live_container"}}) {
    ScanToCommit all;
    for (int flight = 0; flight < (report.options().quick ? 1 : 5); ++flight) {
      report.progress(fmt::format("live flight {} over DDS, {}", flight + 1, arrangement));
      const ScanToCommit one = fly_live(launch);
      all.latency_ms.insert(all.latency_ms.end(), one.latency_ms.begin(), one.latency_ms.end());
      all.scans += one.scans;
      all.commits += one.commits;
    }
    std::ranges::sort(all.latency_ms);
    report.add({{"table", "scan to commit"},
                {"world", "default"},
                {"arrangement", arrangement},
                {"scans", all.scans},
                {"commits", all.commits},
                {"answered", all.latency_ms.size()},
                {"scan_to_commit_p50_ms", at_share(all.latency_ms, 0.5)},
                {"scan_to_commit_p99_ms", at_share(all.latency_ms, 0.99)}});
  }
}

void run_forests(Report& report) {
  const bool quick = report.options().quick;
  for (const double density : {0.05, 0.1, 0.2}) {
    report.progress(fmt::format("forest, {:g} of it blocked", density));
    std::vector<Planner::Times> all;
    int failed = 0;
    for (std::uint64_t seed = 1; seed <= (quick ? 1U : 5U); ++seed) {
      const Flight flight = fly(forest(density, seed), 30.0, 0.25, quick ? 10 : 100);
      all.insert(all.end(), flight.times.begin(), flight.times.end());
      failed += flight.failed;
    }
    using Times = Planner::Times;
    const auto total = [](const Times& t) { return t.all_us(); };
    report.add(
        {{"table", "replan"},
         {"world", fmt::format("forest {:g}", density)},
         {"arrangement", "one thread"},
         {"replans", all.size()},
         {"failed", failed},
         {"compute_p50_ms", share_ms(all, 0.5, total)},
         {"compute_p99_ms", share_ms(all, 0.99, total)},
         {"search_p50_ms", share_ms(all, 0.5, [](const Times& t) { return t.search_us; })},
         {"corridor_p50_ms", share_ms(all, 0.5, [](const Times& t) { return t.corridor_us; })},
         {"optimizer_p50_ms", share_ms(all, 0.5, [](const Times& t) { return t.optimizer_us; })},
         {"stop_p50_ms", share_ms(all, 0.5, [](const Times& t) { return t.stop_us; })}});
  }
}

void run(Report& report) {
  run_forests(report);
  fly_live_flights(report);
}

}  // namespace
}  // namespace goshawk::bench

int main(int argc, char** argv) {
  return goshawk::bench::bench_main(argc, argv, "replan", goshawk::bench::run);
}
