#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "common/measure.hpp"
#include "goshawk/core/inflation.hpp"
#include "goshawk/trajectory_optimizer/time_profile.hpp"
#include "goshawk/worlds/world.hpp"
#include "parts.hpp"

namespace goshawk::bench {
namespace {

using Json = nlohmann::ordered_json;

constexpr double kGrowth_m = 0.2;
constexpr int kQuickSamplingRuns = 4;

Task task_of(const worlds::WorldSpec& spec, const std::string& name, const Vec3& start,
             const Vec3& goal) {
  auto world = worlds::make_world(spec);
  if (!world) throw std::runtime_error(world.error().message);
  auto grid = std::make_shared<VoxelGrid>();
  grid->geometry = world->geometry;
  grid->grown = inflate(world->occupied, kGrowth_m, spec.resolution_m).value();
  grid->inflation_m = kGrowth_m;
  return {name, spec.density, grid, start, goal, {}};
}

// Numbers of the flights that were solved; medians.
struct Tally {
  int runs = 0, solved = 0, safe = 0, certified = 0;
  std::vector<double> search, corridor, optimise, plan, duration, ratio, length, mean_speed;
  double max_speed = 0.0, max_acceleration = 0.0;

  void add(const Flight& flight, const Task& task) {
    ++runs;
    if (!flight.solved) return;
    ++solved;
    safe += is_safe(flight.trajectory, *task.grid) ? 1 : 0;
    certified += flight.certified ? 1 : 0;
    search.push_back(flight.search_ms);
    corridor.push_back(flight.corridor_ms);
    optimise.push_back(flight.optimise_ms);
    plan.push_back(flight.plan_ms());
    const double duration_s = flight.trajectory.duration_s();
    const double length_m = flight.trajectory.length_m();
    duration.push_back(duration_s);
    length.push_back(length_m);
    mean_speed.push_back(length_m / duration_s);
    // No curve along this path is faster: one straight line of its length, unlimited jerk.
    ratio.push_back(duration_s /
                    trajectory_optimizer::rest_to_rest_duration_s(
                        flight.path_length_m, task.limits.v_max_m_s, task.limits.a_max_m_s2));
    const auto peaks = flight.trajectory.peaks();
    max_speed = std::max(max_speed, peaks.speed_m_s);
    max_acceleration = std::max(max_acceleration, peaks.acceleration_m_s2);
  }

  Json row(const Task& task, const std::string& planner) const {
    const auto middle = [&](const std::vector<double>& v) {
      return v.empty() ? Json() : Json(median(v));
    };
    return {{"world", task.world},
            {"density", task.density},
            {"planner", planner},
            {"runs", runs},
            {"solved", solved},
            {"safe", safe},
            {"certified", certified},
            {"search_ms", middle(search)},
            {"corridor_ms", middle(corridor)},
            {"optimise_ms", middle(optimise)},
            {"plan_ms", middle(plan)},
            {"duration_s", middle(duration)},
            {"duration_over_bound", middle(ratio)},
            {"length_m", middle(length)},
            {"mean_speed_m_s", middle(mean_speed)},
            {"max_speed_m_s", solved > 0 ? Json(max_speed) : Json()},
            {"max_acceleration_m_s2", solved > 0 ? Json(max_acceleration) : Json()}};
  }
};

// The thesis, Table 3, density 0.4.
Json thesis_row(const char* planner, double length_m, double generation_s, double speed) {
  return {{"planner", planner},
          {"by", "thesis (MATLAB)"},
          {"length_m", length_m},
          {"generation_s", generation_s},
          {"mean_speed_m_s", speed}};
}

Json measured_row(const std::string& planner, const Tally& tally) {
  if (tally.solved == 0) return {{"planner", planner}, {"by", "measured"}};
  return {{"planner", planner},
          {"by", "measured"},
          {"length_m", median(tally.length)},
          {"generation_s", 1e-3 * median(tally.plan)},
          {"mean_speed_m_s", median(tally.mean_speed)}};
}

}  // namespace

Task box_task(double density, int seed) {
  worlds::WorldSpec spec = worlds::default_world();
  spec.density = density;
  spec.seed = std::uint64_t(seed);
  return task_of(spec, "boxes 6x8x4", Vec3(3, 0, 1), Vec3(3, 8, 2));
}

Task forest_task(double density, int seed) {
  worlds::WorldSpec spec;
  spec.kind = "forest";
  spec.size_m = Vec3(30, 30, 5);
  spec.density = density;
  spec.seed = std::uint64_t(seed);
  const Vec3 start(1, 1, 2), goal(29, 29, 2.5);
  spec.keep_free = {start, goal};
  return task_of(spec, "forest 30x30x5", start, goal);
}

namespace {

/// All planners but those whose search this build lacks.
std::vector<Planner> planners_here(Report& report) {
  std::vector<Planner> planners;
  for (const std::string& name : Planner::names()) {
    if (auto planner = Planner::make(name)) {
      planners.push_back(*std::move(planner));
    } else {
      report.progress(name + " is left out: its search is not built in");
    }
  }
  return planners;
}

void draw_by_density(Report& report) {
  Plot plot{.x = "density",
            .x_label = "density of the grown map",
            .series = "planner",
            .where = {{"world", "boxes 6x8x4"}}};
  report.draw(plot.of("length", "Length of the trajectory", "length_m", "median length [m]"));
  report.draw(plot.of("mean_speed", "Mean speed, limit 2 m/s", "mean_speed_m_s", "median [m/s]"));
  plot.log_y = true;
  report.draw(
      plot.of("generation_time", "Plan, from search to trajectory", "plan_ms", "median time [ms]"));
}

}  // namespace

void measure_flights(Report& report) {
  Json table = Json::array({thesis_row("thesis", 10.561, 0.672, 1.286),
                            thesis_row("minimum_snap", 13.322, 0.913, 1.372),
                            thesis_row("minimum_jerk", 10.729, 0.821, 1.273)});
  std::vector<Planner> planners = planners_here(report);
  const bool quick = report.options().quick;
  const auto measure = [&](Task (*make)(double, int), double density, int runs, bool baselines) {
    std::vector<Tally> tallies(planners.size());
    Task task;
    for (int seed = 1; seed <= runs; ++seed) {
      task = make(density, seed);
      for (std::size_t i = 0; i < planners.size(); ++i) {
        if (i > 0 && !baselines) continue;
        if (quick && planners[i].samples() && seed > kQuickSamplingRuns) continue;
        tallies[i].add(planners[i].fly(task), task);
      }
    }
    report.progress(task.world + " at density " + fmt::format("{:.2g}", density));
    for (std::size_t i = 0; i < planners.size(); ++i) {
      if (tallies[i].runs == 0) continue;
      report.add(tallies[i].row(task, planners[i].name()));
      if (density == 0.4) table.push_back(measured_row(planners[i].name(), tallies[i]));
    }
  };
  for (const double density : {0.1, 0.2, 0.3, 0.4})
    measure(box_task, density, quick ? 15 : 50, true);
  for (const double density : {0.1, 0.2}) measure(forest_task, density, quick ? 2 : 10, false);
  report.note("thesis_table_3", table);
  draw_by_density(report);
}

}  // namespace goshawk::bench
