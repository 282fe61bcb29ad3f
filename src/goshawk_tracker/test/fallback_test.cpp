#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "closed_loop.hpp"

// The tracker dies, at every moment of a turn between obstacles.

namespace goshawk::tracker {
namespace {

constexpr double kRadius_m = 0.25;  // of the vehicle
constexpr double kMargin_m = 0.05;

// Out at 2 m/s, half a circle of 1.6 m, and back.
Draft there_and_back() {
  Draft draft;
  const FlatState states[] = {
      {.position = {0, 0, 1}},
      {.position = {2, 0, 1}, .velocity = {2, 0, 0}},
      {.position = {3.6, 1.6, 1.2}, .velocity = {0, 2, 0}, .acceleration = {-2.5, 0, 0}},
      {.position = {2, 3.2, 1.4}, .velocity = {-2, 0, 0}},
      {.position = {0, 3.2, 1.4}}};
  const double durations[] = {2.0, 1.27, 1.27, 2.0};
  for (int i = 0; i < 4; ++i) {
    draft.trajectory.pieces.push_back(BezierPiece::between(states[i], states[i + 1], durations[i]));
  }
  draft.start_time_ns = kSecond;
  certify_as_is(draft);
  return draft;
}

/// Obstacles on both sides all along the path, as near as a grown map allows.
class Walls {
 public:
  explicit Walls(const Trajectory& path) {
    const double end_s = path.duration_s();
    for (double t = 0.0; t <= end_s; t += 0.005) path_.push_back(path.sample(t).position);
    for (std::size_t i = 1; i < path_.size(); ++i) {
      const Vec3 along = (path_[i] - path_[i - 1]).normalized();
      const Vec3 aside = Vec3(-along.y(), along.x(), 0.0).normalized();
      for (const double side : {-1.0, 1.0}) {
        const Vec3 point = path_[i] + side * (kRadius_m + kMargin_m) * aside;
        if (to_path(point) > kRadius_m + kMargin_m - 1e-3) points_.push_back(point);
      }
    }
  }

  double to_path(const Vec3& p) const { return nearest(path_, p); }
  bool touched_at(const Vec3& p) const { return nearest(points_, p) < kRadius_m; }

 private:
  static double nearest(const std::vector<Vec3>& points, const Vec3& p) {
    double least = HUGE_VAL;
    for (const Vec3& point : points) least = std::min(least, (point - p).squaredNorm());
    return std::sqrt(least);
  }
  std::vector<Vec3> path_;
  std::vector<Vec3> points_;
};

/// What came of a flight whose tracker was killed.
struct Outcome {
  double off_path_m = 0.0;
  double top_speed_m_s = 0.0;
  bool touched = false;
  bool rests = false;
};

class Kills : public testing::TestWithParam<const char*> {
 protected:
  /// @param dead_s until the tracker is started again
  Outcome kill_at(std::int64_t moment_ns, double dead_s,
                  const simulator::Config& vehicle = {}) const {
    const Config config = without_map(config_for(GetParam()));
    ClosedLoop loop(config, vehicle);
    EXPECT_TRUE(loop.vehicle.reset({0, 0, 1}, 0.0));
    loop.run_until(kSecond / 2);
    EXPECT_TRUE(loop.tracker.accept(path_, loop.vehicle.time_ns()));
    loop.run_until(moment_ns);
    Outcome outcome;
    const auto look = [&] {
      if (loop.vehicle.time_ns() % 10'000'000 != 0) return;
      const auto& state = loop.vehicle.state();
      outcome.off_path_m = std::max(outcome.off_path_m, walls_.to_path(state.position_map));
      outcome.top_speed_m_s = std::max(outcome.top_speed_m_s, state.velocity_map.norm());
      outcome.touched = outcome.touched || walls_.touched_at(state.position_map);
    };
    loop.connected = loop.watched = false;
    loop.run_until(moment_ns + std::llround(dead_s * 1e9), look);
    loop.tracker = Tracker::create(config).value();
    loop.connected = loop.watched = true;
    loop.run_until(moment_ns + std::llround(dead_s * 1e9) + 3 * kSecond, look);
    outcome.rests = loop.vehicle.state().velocity_map.norm() < 0.05 &&
                    loop.vehicle.control() == simulator::Control::commanded;
    return outcome;
  }

  std::int64_t end_ns() const {
    return kSecond + std::llround(path_.trajectory.duration_s() * 1e9);
  }

  Draft path_ = there_and_back();
  Walls walls_{path_.trajectory};
};

TEST_P(Kills, OfTheTrackerAtEveryMomentOfATurnTouchNothing) {
  Random random(7);
  Outcome worst;
  int kills = 0;
  for (std::int64_t t = kSecond; t < end_ns(); t += 20'000'000, ++kills) {
    SCOPED_TRACE(t);
    const Outcome outcome = kill_at(t, random.uniform(0.12, 2.0));
    EXPECT_FALSE(outcome.touched);
    EXPECT_TRUE(outcome.rests);
    worst.off_path_m = std::max(worst.off_path_m, outcome.off_path_m);
    worst.top_speed_m_s = std::max(worst.top_speed_m_s, outcome.top_speed_m_s);
  }
  std::printf("%d kills: at most %.4f m off the path, %.3f m/s\n", kills, worst.off_path_m,
              worst.top_speed_m_s);
  EXPECT_LE(worst.off_path_m, kMargin_m);
  EXPECT_LE(worst.top_speed_m_s, 2.2);  // 1.1 times its limit
}

TEST_P(Kills, InWindTouchNothing) {
  simulator::Config vehicle;
  vehicle.wind_x_m_s = 2.0;
  vehicle.wind_y_m_s = -1.0;
  vehicle.gust_deviation_m_s = 0.5;
  double off_path_m = 0.0;
  for (std::int64_t t = kSecond; t < end_ns(); t += 130'000'000) {
    SCOPED_TRACE(t);
    const Outcome outcome = kill_at(t, 1.0, vehicle);
    EXPECT_FALSE(outcome.touched);
    off_path_m = std::max(off_path_m, outcome.off_path_m);
  }
  std::printf("in wind: at most %.4f m off the path\n", off_path_m);
}

INSTANTIATE_TEST_SUITE_P(Controllers, Kills, testing::Values("pd", "geometric"),
                         [](const auto& each) { return std::string(each.param); });

// The truth: the reference itself.
TEST(FallbackStops, AreTheReferenceUntilTheyBrakeAndThenItsPath) {
  const Draft path = there_and_back();
  Tracker tracker = Tracker::create(without_map(config_for("pd"))).value();
  RigidBodyState state;
  state.position_map = {0, 0, 1};
  ASSERT_TRUE(tracker.step(state, kSecond - 20'000'000));
  ASSERT_TRUE(tracker.accept(path, kSecond - 20'000'000));
  FallbackStop stop;
  const Walls walls(path.trajectory);
  for (std::int64_t t = kSecond; t < kSecond + 6 * kSecond; t += 20'000'000) {
    const auto wanted = [&](std::int64_t time_ns) {
      const double s = double(time_ns - kSecond) * 1e-9;
      return path.trajectory.sample(std::min(s, path.trajectory.duration_s()));
    };
    state.position_map = wanted(t).position;
    state.velocity_map = wanted(t).velocity;
    ASSERT_TRUE(tracker.step(state, t));
    ASSERT_TRUE(tracker.make_fallback(stop, t));
    ASSERT_TRUE(stop.check());
    EXPECT_LT(stop.duration_s(), 0.15 + 1.6);
    for (double ahead = 0.0; ahead < stop.duration_s(); ahead += 0.01) {
      const Vec3 place = stop.at(ahead).position;
      EXPECT_LT(walls.to_path(place), 0.006) << ahead;  // the path is looked at every centimetre
      if (ahead > 0.15) continue;
      EXPECT_LT((place - wanted(t + std::llround(ahead * 1e9)).position).norm(), 1e-3) << ahead;
    }
  }
}

TEST(FallbackStops, OfTheLastNanosecondBeforeRestAreWhatAVehicleTakes) {
  const Draft path = there_and_back();
  const std::int64_t end_ns = kSecond + std::llround(path.trajectory.duration_s() * 1e9);
  Tracker tracker = Tracker::create(without_map(config_for("pd"))).value();
  RigidBodyState state;
  state.position_map = {0, 0, 1};
  ASSERT_TRUE(tracker.step(state, kSecond));
  ASSERT_TRUE(tracker.accept(path, kSecond));
  std::int64_t t = kSecond;
  while (t < end_ns - 1) {
    t = std::min(t + 20'000'000, end_ns - 1);
    const FlatState wanted = path.trajectory.sample(double(t - kSecond) * 1e-9);
    state.position_map = wanted.position;
    state.velocity_map = wanted.velocity;
    ASSERT_TRUE(tracker.step(state, t));
  }
  FallbackStop stop;
  ASSERT_TRUE(tracker.make_fallback(stop, t));
  const Status status = stop.check();
  EXPECT_TRUE(status) << status.error().message;
  EXPECT_LT((stop.at(1.0).position - state.position_map).norm(), 1e-6);
}

TEST(FallbackStops, AreNotMadeOfWhatIsNotKnown) {
  Tracker tracker = Tracker::create(without_map()).value();
  FallbackStop stop{.step_s = 0.5, .states = {}};
  EXPECT_FALSE(tracker.make_fallback(stop, 0)) << "no odometry yet";
  RigidBodyState state;
  state.position_map = {1, 2, 3};
  ASSERT_TRUE(tracker.step(state, 0));
  EXPECT_TRUE(tracker.make_fallback(stop, 0));
  ASSERT_EQ(stop.states.size(), 1u);
  EXPECT_EQ(stop.at(0.0).position, state.position_map);
  tracker.watch(kSecond);
  EXPECT_FALSE(tracker.make_fallback(stop, kSecond)) << "odometry is lost";
}

// A tracker that is started beside a moving vehicle does not know its path. The vehicle's fallback
// stop does.
TEST(ATrackerThatStarts, LeavesAMovingVehicleAloneUntilItRests) {
  Tracker tracker = Tracker::create(without_map()).value();
  RigidBodyState state;
  state.velocity_map = {1.5, 0, 0};
  for (std::int64_t t = 0; t < 2 * kSecond; t += 4'000'000) {
    const auto command = tracker.step(state, t);
    ASSERT_EQ(command.code(), ErrorCode::tracking_lost);
    EXPECT_EQ(tracker.status().mode, Mode::idle);
  }
  state.position_map = {1, 0, 0};
  state.velocity_map.setZero();
  ASSERT_TRUE(tracker.step(state, 2 * kSecond));
  EXPECT_EQ(tracker.status().mode, Mode::hold);
  EXPECT_EQ(tracker.status().reference.position, state.position_map);
}

TEST(ATrackerThatStarts, StopsAVehicleThatNobodyStops) {
  Tracker tracker = Tracker::create(without_map()).value();
  RigidBodyState state;
  state.velocity_map = {1.5, 0, 0};
  std::int64_t t = 0;
  for (; !tracker.step(state, t); t += 4'000'000) ASSERT_LT(t, 10 * kSecond);
  EXPECT_GT(t, 4 * kSecond);
  EXPECT_EQ(tracker.status().mode, Mode::brake);
}

}  // namespace
}  // namespace goshawk::tracker
