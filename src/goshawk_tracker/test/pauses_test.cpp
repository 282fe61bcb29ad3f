#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "closed_loop.hpp"
#include "goshawk/plant/world_time.hpp"

// Everything stops together and goes on: a suspended machine with the simulated world in it.

namespace goshawk::tracker {
namespace {

constexpr double kLimit_m_s = 2.0;

struct Seen {
  double speed_m_s = 0.0;
  double off_path_m = 0.0;
};

class Pauses : public testing::TestWithParam<const char*> {
 protected:
  Seen pause_at(const Draft& path, std::int64_t moment_ns, double pause_s, double later_s) const {
    ClosedLoop loop(without_map(config_for(GetParam())), {});
    EXPECT_TRUE(loop.vehicle.reset(path.start.position, 0.0));
    loop.run_until(kSecond / 2);
    EXPECT_TRUE(loop.tracker.accept(path, loop.now_ns()));
    loop.run_until(moment_ns);
    loop.stop_everything(
        pause_s, std::getenv("OLD") ? std::min(pause_s, 0.1) : plant::world_time_s(pause_s, 0.004));
    loop.stalled_until_ns = loop.now_ns() + std::llround(later_s * 1e9);
    Seen seen;
    loop.run_until(loop.now_ns() + 3 * kSecond, [&] {
      seen.speed_m_s = std::max(seen.speed_m_s, loop.vehicle.state().velocity_map.norm());
      if (loop.vehicle.time_ns() % 20'000'000 != 0) return;
      double least = HUGE_VAL;
      for (double t = 0; t <= path.trajectory.duration_s(); t += 0.01) {
        least = std::min(
            least, (path.trajectory.sample(t).position - loop.vehicle.state().position_map).norm());
      }
      seen.off_path_m = std::max(seen.off_path_m, least);
    });
    return seen;
  }
};

TEST_P(Pauses, OfEverythingMakeNothingFasterAndLeaveNoPath) {
  Random random(3);
  Seen worst;
  for (int flight = 0; flight < 4; ++flight) {
    Draft path = random_trajectory(random, {3, 0, 1}, 4, kLimit_m_s, 2.4);
    path.start_time_ns = kSecond;
    const auto end = kSecond + std::llround(path.trajectory.duration_s() * 1e9);
    for (std::int64_t t = kSecond; t < end; t += 160'000'000) {
      const double pause = std::pow(10.0, random.uniform(-1.3, 1.0));
      const double later = random.chance(0.5) ? 0.0 : random.uniform(0.0, 0.2);
      const Seen seen = pause_at(path, t, pause, later);
      if (seen.speed_m_s > worst.speed_m_s)
        std::printf("%.3f m/s at %.2f pause %.3f later %.3f\n", seen.speed_m_s, double(t) * 1e-9,
                    pause, later);
      worst.speed_m_s = std::max(worst.speed_m_s, seen.speed_m_s);
      worst.off_path_m = std::max(worst.off_path_m, seen.off_path_m);
    }
  }
  std::printf("at most %.3f m/s, %.4f m off the path\n", worst.speed_m_s, worst.off_path_m);
  EXPECT_LE(worst.speed_m_s, 1.1 * kLimit_m_s);
  EXPECT_LE(worst.off_path_m, 0.05);
}

INSTANTIATE_TEST_SUITE_P(Controllers, Pauses, testing::Values("pd", "geometric"),
                         [](const auto& each) { return std::string(each.param); });

}  // namespace
}  // namespace goshawk::tracker
