#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "closed_loop.hpp"
#include "goshawk/plant/world_time.hpp"

// Everything stops together and goes on: a suspended machine with the simulated world in it.

namespace goshawk::tracker {
namespace {

constexpr double kFastest_m_s = 2.0;
// More than the margin of 0.05 m: after a pause the vehicle is stopped where it is, and from a turn
// that stop returns to the path across the corner. There is no map that forbids it here.
constexpr double kCutCorner_m = 0.15;

struct Seen {
  double speed_m_s = 0.0;
  double off_path_m = 0.0;
};

class Pauses : public testing::TestWithParam<const char*> {
 protected:
  /// @param later_s by how much later than the vehicle the tracker goes on
  Seen pause_at(const Draft& path, std::int64_t moment_ns, double pause_s, double later_s) const {
    ClosedLoop loop(without_map(config_for(GetParam())), {});
    EXPECT_TRUE(loop.vehicle.reset(path.start.position, 0.0));
    loop.run_until(kSecond / 2);
    EXPECT_TRUE(loop.tracker.accept(path, loop.now_ns()));
    loop.run_until(moment_ns);
    loop.stop_everything(pause_s, plant::world_time_s(pause_s, 0.004));
    loop.stalled_until_ns = loop.now_ns() + std::llround(later_s * 1e9);
    Seen seen;
    loop.run_until(loop.now_ns() + 3 * kSecond, [&] {
      const auto& state = loop.vehicle.state();
      seen.speed_m_s = std::max(seen.speed_m_s, state.velocity_map.norm());
      if (loop.vehicle.time_ns() % 20'000'000 != 0) return;
      seen.off_path_m = std::max(seen.off_path_m, to_path(path.trajectory, state.position_map));
    });
    return seen;
  }

  static double to_path(const Trajectory& path, const Vec3& position) {
    double least_m = HUGE_VAL;
    for (double t = 0.0; t <= path.duration_s(); t += 0.01) {
      least_m = std::min(least_m, (path.sample(t).position - position).norm());
    }
    return least_m;
  }
};

TEST_P(Pauses, OfEverythingMakeNothingFasterAndLeadNowhereElse) {
  Random random(3);
  Seen worst;
  for (int flight = 0; flight < 4; ++flight) {
    Draft path = random_trajectory(random, {3, 0, 1}, 4, kFastest_m_s, 2.4);
    path.start_time_ns = kSecond;
    const auto end_ns = kSecond + std::llround(path.trajectory.duration_s() * 1e9);
    for (std::int64_t t = kSecond; t < end_ns; t += 160'000'000) {
      const double pause_s = std::pow(10.0, random.uniform(-1.3, 1.0));
      const double later_s = random.chance(0.5) ? 0.0 : random.uniform(0.0, 0.2);
      const Seen seen = pause_at(path, t, pause_s, later_s);
      worst.speed_m_s = std::max(worst.speed_m_s, seen.speed_m_s);
      worst.off_path_m = std::max(worst.off_path_m, seen.off_path_m);
    }
  }
  std::printf("at most %.3f m/s, %.4f m off the path\n", worst.speed_m_s, worst.off_path_m);
  EXPECT_LE(worst.speed_m_s, 1.1 * kFastest_m_s);
  EXPECT_LE(worst.off_path_m, kCutCorner_m);
}

INSTANTIATE_TEST_SUITE_P(Controllers, Pauses, testing::Values("pd", "geometric"),
                         [](const auto& each) { return std::string(each.param); });

}  // namespace
}  // namespace goshawk::tracker
