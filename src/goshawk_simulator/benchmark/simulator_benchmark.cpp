#include <benchmark/benchmark.h>

#include "goshawk/simulator/quadrotor.hpp"

namespace goshawk::simulator {
namespace {

// One simulated second a round, in the 4 ms portions of 250 Hz odometry.
void one_second(benchmark::State& state) {
  Config config;
  config.gust_deviation_m_s = state.range(0) != 0 ? 1.0 : 0.0;
  auto quadrotor = Quadrotor::create(config).value();
  for (auto _ : state) {
    for (int i = 0; i < 250; ++i) benchmark::DoNotOptimize(quadrotor.advance(0.004));
  }
  state.counters["times_real_time"] =
      benchmark::Counter(double(state.iterations()), benchmark::Counter::kIsRate);
}

BENCHMARK(one_second)->ArgName("gusts")->Arg(0)->Arg(1)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace goshawk::simulator

BENCHMARK_MAIN();
