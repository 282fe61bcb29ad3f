// goshawk bench tracking: planned flights through the thesis' worlds, flown in closed loop by both
// controllers, in several weathers, on both plants; judged by the second opinion. Simulated time
// alone: the same figures on every machine, but for the step times.

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>

#include "common/measure.hpp"
#include "common/report.hpp"
#include "goshawk/core/inflation.hpp"
#include "goshawk/corridor_builder/corridor_builder.hpp"
#include "goshawk/flight_check/flight_check.hpp"
#include "goshawk/map_server/octree.hpp"
#include "goshawk/mujoco/mujoco_plant.hpp"
#include "goshawk/path_search/path_search.hpp"
#include "goshawk/simulator/quadrotor.hpp"
#include "goshawk/tracker/tracker.hpp"
#include "goshawk/trajectory_optimizer/trajectory_optimizer.hpp"
#include "goshawk/worlds/world.hpp"

namespace goshawk::bench {
namespace {

constexpr double kBodyRadius_m = 0.15;
constexpr double kMargin_m = 0.05;
constexpr int kOdometryEvery_ms = 4;
constexpr std::int64_t kStart_ns = 1'000'000'000;

struct Mission {
  CommittedTrajectory committed;
  std::shared_ptr<const VoxelGrid> grid;
  std::shared_ptr<flight_check::FlightCheck> judge;
};

Result<Mission> plan(double density, std::uint64_t seed) {
  auto spec = worlds::default_world();
  spec.density = density;
  spec.seed = seed;
  const auto world = worlds::make_world(spec);
  if (!world) return world.error();
  const auto tree = map_server::make_octree(world->geometry, world->occupied, {});
  if (!tree) return tree.error();
  auto judge = flight_check::FlightCheck::from_payload(map_server::binary_payload(**tree),
                                                       world->geometry.resolution_m,
                                                       {.radius_m = kBodyRadius_m});
  if (!judge) return judge.error();
  const double growth_m = kBodyRadius_m + kMargin_m;
  auto blocked = inflate(world->occupied, growth_m, world->geometry.resolution_m);
  if (!blocked) return blocked.error();
  const auto grid = std::make_shared<const VoxelGrid>(VoxelGrid{.geometry = world->geometry,
                                                                .grown = *std::move(blocked),
                                                                .known = {},
                                                                .inflation_m = growth_m});
  auto search = path_search::PathSearch::create({}).value();
  search.set_map(grid);
  const auto path = search.plan(Vec3(3, 0, 1), Vec3(3, 8, 2));
  if (!path) return path.error();
  auto corridor =
      corridor_builder::CorridorBuilder::create({}).value().build(*grid, path->waypoints_map);
  if (!corridor) return corridor.error();
  const FlatState start{.position = path->waypoints_map.front()};
  const FlatState goal{.position = path->waypoints_map.back()};
  const PlanRequest request{.start = start, .goal = goal, .limits = {}};
  auto solution =
      trajectory_optimizer::TrajectoryOptimizer::create({}).value().optimise(request, *corridor);
  if (!solution) return solution.error();
  auto committed = CommittedTrajectory::make(
      {.id = seed, .nominal = std::move(solution->certified), .start_time_ns = kStart_ns});
  if (!committed) return committed.error();
  return Mission{*std::move(committed), grid,
                 std::make_shared<flight_check::FlightCheck>(*std::move(judge))};
}

struct Weather {
  const char* name;
  simulator::Config config;
};

std::vector<Weather> weathers() {
  std::vector<Weather> list(4);
  list[0].name = "calm";
  list[1].name = "wind";  // 3 m/s and gusts
  list[1].config.wind_x_m_s = 3.0;
  list[1].config.gust_deviation_m_s = 1.0;
  list[2].name = "gusts";  // peaks of 3 m/s and more from all sides
  list[2].config.gust_deviation_m_s = 1.5;
  list[3].name = "noise";
  list[3].config.sensor = {.position_noise_m = 0.005,
                           .velocity_noise_m_s = 0.03,
                           .attitude_noise_rad = 0.005,
                           .body_rate_noise_rad_s = 0.02,
                           .delay_s = 0.02};
  return list;
}

struct Flown {
  double rms_m = 0.0;
  double max_m = 0.0;
  double clearance_m = 0.0;
  bool touched = false;
  bool braked = false;  // its error was beyond the allowance
  bool arrived = false;
};

/// Every tracker step of a row, timed.
using StepTimes = std::vector<double>;

Flown fly(const Mission& mission, const std::string& controller, simulator::Config weather,
          const plant::PlantFactory& plant, StepTimes& steps_us) {
  weather.gust_seed = weather.sensor.seed = int(mission.committed.id());
  auto vehicle = simulator::Quadrotor::create(weather, plant).value();
  tracker::Config config;
  config.controller = controller;
  auto tracker = tracker::Tracker::create(config).value();
  tracker.set_map(mission.grid, vehicle.time_ns());
  Flown flown;
  if (!vehicle.reset(mission.committed.nominal().start().position, 0.0)) return flown;
  const Trajectory& trajectory = mission.committed.flown();
  const double duration_s = trajectory.duration_s();
  const int end_ms = int(1000.0 * (duration_s + 2.0));
  std::vector<flight_check::Sample> track;
  double squares = 0.0;
  int count = 0;
  bool accepted = false;
  for (int ms = 0; ms < end_ms; ++ms) {
    if (ms % kOdometryEvery_ms == 0) {
      const auto m = vehicle.measure();
      const auto begin = std::chrono::steady_clock::now();
      const auto command = tracker.step(m.state, m.time_ns, vehicle.time_ns());
      const std::chrono::duration<double, std::micro> took =
          std::chrono::steady_clock::now() - begin;
      steps_us.push_back(took.count());
      if (command && !vehicle.command(*command)) return flown;
      if (!accepted && ms > 900) {
        accepted = bool(tracker.accept(mission.committed, vehicle.time_ns()));
      }
    }
    if (!vehicle.advance(0.001)) return flown;
    const double t_s = double(vehicle.time_ns() - kStart_ns) * 1e-9;
    if (t_s < 0.0) continue;
    const Vec3 wanted = trajectory.sample(std::min(t_s, duration_s)).position;
    const double error_m = (vehicle.state().position_map - wanted).norm();
    flown.max_m = std::max(flown.max_m, error_m);
    squares += error_m * error_m;
    ++count;
    if (ms % 10 == 0) {
      track.push_back({t_s, vehicle.state().position_map, vehicle.state().q_map_base});
    }
  }
  flown.rms_m = std::sqrt(squares / std::max(1, count));
  flown.braked = tracker.status().lost_trajectory_id != 0;
  flown.arrived = accepted && !flown.braked && tracker.status().mode == tracker::Mode::hold;
  const auto verdict = mission.judge->judge(track);
  flown.touched = !verdict || verdict->touched;
  flown.clearance_m = verdict ? verdict->clearance_m : 0.0;
  return flown;
}

void add_row(Report& report, double density, const std::string& controller,
             const std::string& weather, const std::string& plant,
             const std::vector<Flown>& flights, StepTimes steps_us) {
  std::vector<double> rms_mm, max_mm;
  double clearance_m = 1e9;
  int touched = 0, braked = 0, arrived = 0;
  for (const auto& f : flights) {
    touched += f.touched;
    braked += f.braked;
    arrived += f.arrived;
    clearance_m = std::min(clearance_m, f.clearance_m);
    // One that braked is where its plan is not: its distance from there says nothing.
    if (f.braked) continue;
    rms_mm.push_back(1e3 * f.rms_m);
    max_mm.push_back(1e3 * f.max_m);
  }
  if (rms_mm.empty() || steps_us.empty()) return;
  std::ranges::sort(steps_us);
  report.add({{"table", "tracking"},
              {"density", density},
              {"controller", controller},
              {"weather", weather},
              {"plant", plant},
              {"flights", flights.size()},
              {"arrived", arrived},
              {"braked", braked},
              {"touched", touched},
              {"rms_mm_median", median(rms_mm)},
              {"rms_mm_worst", *std::ranges::max_element(rms_mm)},
              {"max_mm_worst", *std::ranges::max_element(max_mm)},
              {"clearance_mm", 1e3 * clearance_m},
              {"step_us_median", steps_us[steps_us.size() / 2]},
              {"step_us_p99", steps_us[steps_us.size() * 99 / 100]}});
}

void run(Report& report) {
  const int worlds = report.options().quick ? 4 : 50;
  for (const double density : {0.1, 0.2, 0.3, 0.4}) {
    std::vector<Mission> missions;
    for (int seed = 1; seed <= worlds; ++seed) {
      auto mission = plan(density, std::uint64_t(seed));
      if (mission) missions.push_back(*std::move(mission));
    }
    report.note("planned_at_" + fmt::format("{:.2g}", density), missions.size());
    for (const Weather& weather : weathers()) {
      for (const char* controller : {"pd", "geometric"}) {
        for (const bool mujoco : {false, true}) {
          if (mujoco && std::string(weather.name) != "calm") continue;
          report.progress("density " + fmt::format("{:.2g}", density) + ", " + controller + ", " +
                          weather.name + (mujoco ? ", mujoco" : ""));
          std::vector<Flown> flights;
          StepTimes steps_us;
          for (const auto& mission : missions) {
            flights.push_back(fly(mission, controller, weather.config,
                                  mujoco ? plant::PlantFactory(mujoco::make_mujoco_plant)
                                         : plant::PlantFactory(simulator::make_rigid_body),
                                  steps_us));
          }
          add_row(report, density, controller, weather.name, mujoco ? "mujoco" : "ours", flights,
                  std::move(steps_us));
        }
      }
    }
  }
  report.draw({.file = "tracking_error",
               .title = "Largest tracking error of all flights, PD controller",
               .x = "density",
               .y = "max_mm_worst",
               .x_label = "obstacle density",
               .y_label = "largest error [mm]",
               .series = "weather",
               .where = {{"controller", "pd"}, {"plant", "ours"}}});
}

}  // namespace
}  // namespace goshawk::bench

int main(int argc, char** argv) {
  return goshawk::bench::bench_main(argc, argv, "tracking", goshawk::bench::run);
}
