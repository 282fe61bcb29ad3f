// goshawk bench obstacles: a tracker of what moves, judged against the truth.
#include <fmt/format.h>

#include <algorithm>
#include <numeric>
#include <stdexcept>

#include "common/measure.hpp"
#include "common/report.hpp"
#include "goshawk/core/random.hpp"
#include "goshawk/obstacle_tracker_lab/lab.hpp"

namespace goshawk::bench {
namespace {

using namespace goshawk::obstacle_tracker;

nlohmann::ordered_json row(const std::string& table, const LabResult& r) {
  const Figures& f = r.figures;
  std::vector<double> delays = f.delays_s;
  std::ranges::sort(delays);
  const bool any = !delays.empty();
  return {{"table", table},
          {"recall", f.recall},
          {"precision", f.precision},
          {"false_told", f.false_told},
          {"switches", f.switches},
          {"position_error_m", f.position_error_m},
          {"position_p95_m", f.position_p95_m},
          {"velocity_error_m_s", f.velocity_error_m_s},
          {"velocity_p95_m_s", f.velocity_p95_m_s},
          {"delay_median_s", any ? at_share(delays, 0.5) : -1.0},
          {"delay_most_s", any ? delays.back() : -1.0},
          {"never_told", f.never_told},
          {"in_bound_now", f.in_bound[0]},
          {"in_bound_0_5_s", f.in_bound[1]},
          {"in_bound_1_s", f.in_bound[2]},
          {"in_bound_1_5_s", f.in_bound[3]},
          {"scan_mean_us", r.scan_mean_us},
          {"scan_most_us", r.scan_most_us}};
}

LabResult judged(const LabCase& lab_case) {
  auto result = run_lab(lab_case);
  if (!result) throw std::runtime_error(result.error().message);
  return *std::move(result);
}

void cross(Report& report, double distance_m, double speed_m_s, double duration_s) {
  report.progress(fmt::format("a person at {:g} m, {:g} m/s", distance_m, speed_m_s));
  LabCase c{.movers = {crossing_person(1, distance_m, speed_m_s)}, .sensor = lab_lidar()};
  c.duration_s = duration_s;
  auto figures = row("crossing", judged(c));
  figures["distance_m"] = distance_m;
  figures["speed_m_s"] = speed_m_s;
  report.add(std::move(figures));
}

/// People on ways of their own, and the vehicle among them.
void crowd(Report& report, double speed_m_s, double vehicle_m_s, double duration_s) {
  report.progress(
      fmt::format("a crowd at {:g} m/s, the vehicle at {:g} m/s", speed_m_s, vehicle_m_s));
  LabCase c{.sensor = lab_lidar(), .velocity_map = Vec3(vehicle_m_s, 0.0, 0.0)};
  c.duration_s = duration_s;
  Random random(1);
  for (std::uint64_t id = 1; id <= 10; ++id) {
    const double x = 3.0 + 2.5 * double(id);
    movers::WalkParameters p{
        .points_map = {Vec3(x, random.uniform(-6.0, -2.0), 0.9),
                       Vec3(x + random.uniform(-1.0, 1.0), random.uniform(2.0, 6.0), 0.9)},
        .pauses_s = {random.uniform(0.0, 2.0), random.uniform(0.0, 2.0)},
        .speed_m_s = speed_m_s};
    c.movers.push_back({.id = id,
                        .kind = "person",
                        .half_m = Vec3(0.2, 0.25, 0.9),
                        .motion = movers::Walk::create(p).value()});
  }
  auto figures = row("crowd of 10", judged(c));
  figures["speed_m_s"] = speed_m_s;
  figures["vehicle_m_s"] = vehicle_m_s;
  report.add(std::move(figures));
}

/// Nothing moves but the vehicle: whatever is told is false.
void still(Report& report, double vehicle_m_s, double duration_s) {
  report.progress(fmt::format("nothing moves, the vehicle at {:g} m/s", vehicle_m_s));
  LabCase c{.sensor = lab_lidar(), .velocity_map = Vec3(vehicle_m_s, 0.0, 0.0)};
  c.duration_s = duration_s;
  const LabResult r = judged(c);
  report.add({{"table", "nothing moves"},
              {"vehicle_m_s", vehicle_m_s},
              {"scans", r.scans},
              {"false_told", r.figures.false_told},
              {"scan_mean_us", r.scan_mean_us},
              {"scan_most_us", r.scan_most_us}});
}

void run(Report& report) {
  if (report.options().quick) {
    cross(report, 10.0, 2.0, 8.0);
    crowd(report, 1.0, 0.0, 6.0);
    return still(report, 2.0, 3.0);
  }
  for (const double distance_m : {5.0, 10.0, 15.0, 20.0}) {
    for (const double speed_m_s : {1.0, 2.0, 3.0}) cross(report, distance_m, speed_m_s, 24.0);
  }
  for (const double speed_m_s : {1.0, 2.0, 3.0}) {
    for (const double vehicle_m_s : {0.0, 1.0}) crowd(report, speed_m_s, vehicle_m_s, 15.0);
  }
  for (const double vehicle_m_s : {0.0, 2.0, 4.0}) still(report, vehicle_m_s, 8.0);
}

}  // namespace
}  // namespace goshawk::bench

int main(int argc, char** argv) {
  return goshawk::bench::bench_main(argc, argv, "obstacles", goshawk::bench::run);
}
