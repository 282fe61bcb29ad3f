#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

#include "closed_loop.hpp"

namespace goshawk::tracker {
namespace {

constexpr double kVMax_m_s = 2.0;
// The default margin, and a little for the vehicle's own braking, which goes straight on.
constexpr double kOffPath_m = 0.06;

/// A random flight that something happens to, and what the vehicle did.
struct Upset {
  Upset(const Config& config, std::uint64_t seed)
      : random(seed), loop(config, simulator::Config{}) {
    EXPECT_TRUE(loop.vehicle.reset({3, 0, 1}, 0.0));
    loop.run_until(kSecond);
    committed = random_trajectory(random, {3, 0, 1}, 5, kVMax_m_s, 2.4);
    committed.start_time_ns = kSecond;
    EXPECT_TRUE(loop.tracker.accept(committed, loop.vehicle.time_ns()));
  }

  double duration_s() const { return committed.trajectory.duration_s(); }
  void until(std::int64_t end_ns) {
    loop.run_until(end_ns, [&] {
      const auto& state = loop.vehicle.state();
      top_speed_m_s = std::max(top_speed_m_s, state.velocity_map.norm());
      if (loop.vehicle.time_ns() % 20'000'000 == 0) {
        off_path_m = std::max(off_path_m, to_path(state.position_map));
      }
      const auto status = loop.tracker.status();
      if (status.fault.code != ErrorCode::ok) said = status.fault.code;
    });
  }
  double to_path(const Vec3& p) const {
    double least = 1e9;
    for (int i = 0; i <= 200; ++i) {
      const auto s = committed.trajectory.sample(duration_s() * i / 200.0);
      const auto t = std::min(0.5 * duration_s() / 200.0, 0.05);
      // Between two samples the curve is nearly straight.
      const Vec3 off = p - s.position;
      const double along = std::clamp(off.dot(s.velocity.stableNormalized()),
                                      -t * s.velocity.norm(), t * s.velocity.norm());
      least = std::min(least, (off - along * s.velocity.stableNormalized()).norm());
    }
    return least;
  }

  Random random;
  ClosedLoop loop;
  Draft committed;
  double top_speed_m_s = 0.0;
  double off_path_m = 0.0;
  ErrorCode said = ErrorCode::ok;
};

/// What many runs came to.
struct Tally {
  void add(const Upset& upset) {
    ++runs;
    top_speed_m_s = std::max(top_speed_m_s, upset.top_speed_m_s);
    off_path_m = std::max(off_path_m, upset.off_path_m);
  }
  ~Tally() {
    std::printf("%d runs, top speed %.3f m/s, at most %.3f m off the path\n", runs, top_speed_m_s,
                off_path_m);
  }
  int runs = 0;
  double top_speed_m_s = 0.0;
  double off_path_m = 0.0;
};

class Upsets : public testing::TestWithParam<const char*> {
 protected:
  /// Until a random moment in flight.
  std::int64_t fly(Upset& upset) const {
    const double share = upset.random.uniform(0.2, 0.9);
    const auto moment = kSecond + std::llround(share * upset.duration_s() * 1e9);
    upset.until(moment);
    EXPECT_EQ(upset.said, ErrorCode::ok);
    return moment;
  }
  void expect_stopped(const Upset& upset, ErrorCode code) const {
    EXPECT_EQ(upset.said, code);
    EXPECT_EQ(upset.loop.tracker.status().lost_trajectory_id, upset.committed.id);
    EXPECT_EQ(upset.loop.tracker.status().mode, Mode::hold);
    EXPECT_LT(upset.loop.vehicle.state().velocity_map.norm(), 0.05);
    EXPECT_LT(upset.loop.tracker.status().error_m, 0.02);
  }

  Config config_ = config_for(GetParam());
  const std::vector<double> pauses_s_{0.05, 0.09, 0.12, 0.2, 0.35, 0.5, 0.8, 1.0, 2.0, 4.0, 10.0};
};

TEST_P(Upsets, AStalledTrackerStopsTheVehicleWhereItIsAndChasesNothing) {
  Tally tally;
  for (std::uint64_t seed = 1; seed <= 55; ++seed) {
    SCOPED_TRACE(seed);
    Upset upset(config_, seed);
    const double pause_s = pauses_s_[seed % pauses_s_.size()];
    upset.loop.stalled_until_ns = fly(upset) + std::llround(pause_s * 1e9);
    upset.until(upset.loop.stalled_until_ns + 4 * kSecond);
    tally.add(upset);
    if (pause_s > 0.1) {
      expect_stopped(upset, ErrorCode::process_stalled);
    } else {
      EXPECT_EQ(upset.said, ErrorCode::ok);
    }
  }
  EXPECT_LE(tally.top_speed_m_s, 1.1 * kVMax_m_s);
  EXPECT_LE(tally.off_path_m, kOffPath_m);
}

TEST_P(Upsets, OdometryThatPausesStopsTheVehicleWhereItIs) {
  Tally tally;
  for (std::uint64_t seed = 201; seed <= 255; ++seed) {
    SCOPED_TRACE(seed);
    Upset upset(config_, seed);
    const double pause_s = pauses_s_[seed % pauses_s_.size()];
    const std::int64_t begin_ns = fly(upset);
    upset.loop.connected = false;
    upset.until(begin_ns + std::llround(pause_s * 1e9));
    upset.loop.connected = true;
    upset.until(upset.loop.vehicle.time_ns() + 4 * kSecond);
    tally.add(upset);
    if (pause_s > 0.1) {
      expect_stopped(upset, ErrorCode::tracking_lost);
    } else {
      EXPECT_EQ(upset.said, ErrorCode::ok);
    }
  }
  EXPECT_LE(tally.top_speed_m_s, 1.1 * kVMax_m_s);
  EXPECT_LE(tally.off_path_m, kOffPath_m);
}

// Odometry shifts for good: by more than the allowance is a loss. Up to max_jump_m it counts as an
// error, which is taken back.
TEST_P(Upsets, OdometryThatJumpsStopsTheVehicleWhereItIs) {
  Tally tally;
  for (std::uint64_t seed = 401; seed <= 440; ++seed) {
    SCOPED_TRACE(seed);
    Upset upset(config_, seed);
    const std::int64_t begin_ns = fly(upset);
    Vec3 shift(upset.random.uniform(-1, 1), upset.random.uniform(-1, 1),
               upset.random.uniform(-1, 1));
    shift *= std::pow(10.0, upset.random.uniform(-1.1, 1.0)) / shift.norm();
    upset.loop.link.spoil = [&](RigidBodyState& state) { state.position_map += shift; };
    upset.until(begin_ns + 4 * kSecond);
    tally.add(upset);
    expect_stopped(upset, ErrorCode::tracking_lost);
  }
  EXPECT_LE(tally.top_speed_m_s, 1.1 * kVMax_m_s);
  EXPECT_LE(tally.off_path_m, kOffPath_m + config_.max_jump_m);
}

// A second vehicle's odometry between that of the first: neither is believed.
TEST_P(Upsets, OdometryOfTwoSourcesIsFlownOnByNobody) {
  Tally tally;
  for (std::uint64_t seed = 501; seed <= 520; ++seed) {
    SCOPED_TRACE(seed);
    Upset upset(config_, seed);
    const std::int64_t begin_ns = fly(upset);
    int count = 0;
    upset.loop.link.spoil = [&](RigidBodyState& state) {
      if (++count % 2 == 0) return;
      state.position_map = {0, 0, 1};
      state.velocity_map = {0.5, 0, 0};
    };
    upset.until(begin_ns + 2 * kSecond);
    EXPECT_EQ(upset.said, ErrorCode::tracking_lost);
    EXPECT_EQ(upset.loop.vehicle.control(), simulator::Control::failsafe);
    upset.loop.link.spoil = {};
    upset.until(begin_ns + 5 * kSecond);
    EXPECT_EQ(upset.loop.vehicle.control(), simulator::Control::commanded);
    tally.add(upset);
    expect_stopped(upset, ErrorCode::tracking_lost);
  }
  EXPECT_LE(tally.top_speed_m_s, 1.1 * kVMax_m_s);
  // Until the second jump the first command or two believe the other vehicle.
  EXPECT_LE(tally.off_path_m, kOffPath_m + 0.04);
}

INSTANTIATE_TEST_SUITE_P(Controllers, Upsets, testing::Values("pd", "geometric"),
                         [](const auto& each) { return std::string(each.param); });

}  // namespace
}  // namespace goshawk::tracker
