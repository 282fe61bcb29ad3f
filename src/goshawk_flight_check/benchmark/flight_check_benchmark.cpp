// How long a verdict takes: a flight of 10 s at 100 Hz that weaves through the scanned building.
// Needs the shared maps: GOSHAWK_DATA names their folder.
#include <benchmark/benchmark.h>

#include <cmath>
#include <cstdlib>

#include "goshawk/core/random.hpp"
#include "goshawk/flight_check/flight_check.hpp"

namespace goshawk::flight_check {
namespace {

std::filesystem::path building() {
  const char* data = std::getenv("GOSHAWK_DATA");
  return std::filesystem::path(data != nullptr ? data : "../shared/data") / "octomap/geb079.bt";
}

/// A closed curve of `radius_m` about a centre that the check itself finds clear, tilting on the
/// way as a quadrotor does.
std::vector<Sample> loop(const Vec3& center, double radius_m) {
  std::vector<Sample> track;
  for (int k = 0; k <= 1000; ++k) {
    const double phase = 2.0 * M_PI * k / 1000.0;
    const Vec3 out(std::cos(phase), std::sin(phase), 0.2 * std::sin(2.0 * phase));
    const Eigen::Quaterniond q(Eigen::AngleAxisd(0.2, Vec3(-out.y(), out.x(), 0.0).normalized()));
    track.push_back({0.01 * k, center + radius_m * out, q});
  }
  return track;
}

std::vector<Sample> clear_loop(const FlightCheck& check, double radius_m) {
  Random random(1);
  for (int attempt = 0; attempt < 2000; ++attempt) {
    const Vec3 center(random.uniform(-7, 29), random.uniform(-6, 6), random.uniform(0.6, 1.6));
    const auto track = loop(center, radius_m);
    const Verdict v = check.judge(track).value();
    if (!v.touched && v.clearance_m < 0.3) return track;
  }
  return {};
}

void Judge(benchmark::State& state) {
  const auto check = FlightCheck::open(building());
  if (!check) return state.SkipWithError(check.error().message.c_str());
  const auto track = clear_loop(*check, double(state.range(0)) / 10.0);
  if (track.empty()) return state.SkipWithError("found no clear loop");
  Verdict verdict;
  for (auto _ : state) verdict = check->judge(track).value();
  state.counters["queries"] = double(verdict.queries);
  state.counters["clearance_m"] = verdict.clearance_m;
}
BENCHMARK(Judge)->Arg(3)->Arg(6)->Arg(9)->Unit(benchmark::kMillisecond);

void Open(benchmark::State& state) {
  for (auto _ : state) benchmark::DoNotOptimize(FlightCheck::open(building()));
}
BENCHMARK(Open)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace goshawk::flight_check

BENCHMARK_MAIN();
