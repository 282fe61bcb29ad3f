#include <benchmark/benchmark.h>

#include <stdexcept>

#include "goshawk/tracker/tracker.hpp"

namespace goshawk::tracker {
namespace {

// Back and forth in `pieces` quintics from rest to rest, a second each.
CommittedTrajectory there_and_back(int pieces) {
  Trajectory trajectory;
  for (int k = 0; k < pieces; ++k) {
    const FlatState near_end{.position = {0, 0, 1}}, far_end{.position = {0.2, 0, 1}};
    trajectory.pieces.push_back(k % 2 == 0 ? BezierPiece::between(near_end, far_end, 1.0)
                                           : BezierPiece::between(far_end, near_end, 1.0));
  }
  const FlatState start = trajectory.pieces.front().sample(0.0);
  const FlatState goal = trajectory.pieces.back().sample(1.0);
  auto certified =
      certify(std::move(trajectory), {Polytope::box(Vec3::Constant(-5.0), Vec3::Constant(5.0))},
              {.v_max_m_s = 2.0, .a_max_m_s2 = 5.0}, start, goal);
  return CommittedTrajectory::make({.id = 1, .nominal = std::move(certified).value()}).value();
}

void step(benchmark::State& state, const char* controller) {
  const int pieces = int(state.range(0));
  Config config;
  config.controller = controller;
  config.require_map = false;
  auto tracker = Tracker::create(config).value();
  const auto committed = there_and_back(pieces);
  RigidBodyState body;
  body.position_map = committed.nominal().start().position;
  std::int64_t now_ns = 0;
  const auto begin_again = [&] {
    now_ns = 0;
    tracker = Tracker::create(config).value();
    if (!tracker.step(body, 0) || !tracker.accept(committed, 0)) {
      throw std::logic_error("the benchmark's trajectory was refused");
    }
  };
  begin_again();
  for (auto _ : state) {
    now_ns += 4'000'000;
    if (now_ns > std::int64_t(pieces) * 1'000'000'000) {
      state.PauseTiming();
      begin_again();
      state.ResumeTiming();
    }
    benchmark::DoNotOptimize(tracker.step(body, now_ns));
  }
}

void accept(benchmark::State& state) {
  Config config;
  config.require_map = false;
  auto tracker = Tracker::create(config).value();
  const auto committed = there_and_back(int(state.range(0)));
  RigidBodyState body;
  body.position_map = committed.nominal().start().position;
  if (!tracker.step(body, 0)) throw std::logic_error("the benchmark's odometry was refused");
  for (auto _ : state) benchmark::DoNotOptimize(tracker.accept(committed, 0));
}

BENCHMARK_CAPTURE(step, pd, "pd")->Arg(10)->Arg(100);
BENCHMARK_CAPTURE(step, geometric, "geometric")->Arg(10);
BENCHMARK(accept)->Arg(10)->Arg(100);

}  // namespace
}  // namespace goshawk::tracker

BENCHMARK_MAIN();
