#include <gmock/gmock.h>

#include "closed_loop.hpp"
#include "trajectories.hpp"

// What the vehicle says of who flies it.

namespace goshawk::tracker {
namespace {

using testing::HasSubstr;

struct Hover {
  Hover() : loop({}, simulator::Config{}) {
    EXPECT_TRUE(loop.vehicle.reset(kPlace, 0.0));
    loop.run_until(kSecond);
    now_ns = loop.now_ns();
  }
  /// For so long its pilot moves it along x; setpoints go on, and are not flown.
  void moved_by_its_pilot(double distance_m, double duration_s) {
    const std::int64_t begin_ns = now_ns;
    for (; now_ns < begin_ns + std::llround(duration_s * 1e9); now_ns += 4'000'000) {
      const double share = double(now_ns - begin_ns) * 1e-9 / duration_s;
      RigidBodyState state;
      state.position_map = kPlace + Vec3(share * distance_m, 0, 0);
      state.velocity_map = Vec3(distance_m / duration_s, 0, 0);
      const auto command = loop.tracker.step(state, now_ns);
      EXPECT_TRUE(command) << command.error().message;
      if (now_ns % 48'000'000 == 0) loop.tracker.heard_vehicle(Control::pilot, now_ns);
    }
    EXPECT_TRUE(loop.vehicle.reset(kPlace + Vec3(distance_m, 0, 0), 0.0));
  }

  static inline const Vec3 kPlace{0, 0, 1};
  ClosedLoop loop;
  std::int64_t now_ns = 0;
};

Draft line_from(const Vec3& from_map, std::int64_t start_ns) {
  auto committed = straight_line(from_map, from_map + Vec3(0, 4, 0), 4.0);
  committed.start_time_ns = start_ns;
  return committed;
}

TEST(ControlOfTheVehicle, NothingIsAcceptedWhileItsSetpointsAreNotFlownAndTheCauseIsNamed) {
  Hover hover;
  auto& tracker = hover.loop.tracker;
  const auto line = line_from(Hover::kPlace, hover.now_ns);
  for (const auto& [control, why] : {std::pair{Control::autopilot, "its autopilot has control"},
                                     std::pair{Control::pilot, "its pilot has control"},
                                     std::pair{Control::nobody, "its motors are not armed"}}) {
    tracker.heard_vehicle(control, hover.now_ns);
    const Status refused = tracker.accept(line, hover.now_ns);
    EXPECT_EQ(refused.code(), ErrorCode::tracking_lost);
    EXPECT_THAT(refused.error().message, HasSubstr("does not fly the setpoints"));
    EXPECT_THAT(refused.error().message, HasSubstr(why));
  }
  tracker.heard_vehicle(Control::goshawk, hover.now_ns);
  EXPECT_TRUE(tracker.accept(line, hover.now_ns));
}

TEST(ControlOfTheVehicle, IsBelievedForASecond) {
  Hover hover;
  auto& tracker = hover.loop.tracker;
  tracker.heard_vehicle(Control::autopilot, hover.now_ns);
  hover.loop.run_until(hover.now_ns + kSecond * 9 / 10);
  const auto soon_ns = hover.loop.now_ns();
  EXPECT_FALSE(tracker.accept(line_from(Hover::kPlace, soon_ns), soon_ns));
  hover.loop.run_until(hover.now_ns + kSecond * 11 / 10);
  const auto later_ns = hover.loop.now_ns();
  EXPECT_TRUE(tracker.accept(line_from(Hover::kPlace, later_ns), later_ns));
}

TEST(ControlOfTheVehicle, AnErrorThatItExplainsIsPutDownToIt) {
  Hover hover;
  auto& tracker = hover.loop.tracker;
  ASSERT_TRUE(tracker.accept(line_from(Hover::kPlace, hover.now_ns), hover.now_ns));
  hover.loop.run_until(hover.now_ns + kSecond);
  hover.now_ns = hover.loop.now_ns();
  tracker.heard_vehicle(Control::autopilot, hover.now_ns);
  // The setpoints lead away from a vehicle that stands still.
  const RigidBodyState stands = hover.loop.vehicle.state();
  for (int k = 0; k < 250 && tracker.status().lost_trajectory_id == 0; ++k) {
    hover.now_ns += 4'000'000;
    RigidBodyState state = stands;
    state.velocity_map.setZero();
    ASSERT_TRUE(tracker.step(state, hover.now_ns));
    tracker.heard_vehicle(Control::autopilot, hover.now_ns);
  }
  EXPECT_EQ(tracker.status().lost_trajectory_id, 1U);
  EXPECT_EQ(tracker.status().fault.code, ErrorCode::tracking_lost);
  EXPECT_THAT(tracker.status().fault.message, HasSubstr("its autopilot has control"));
}

TEST(ControlOfTheVehicle, GivenBackElsewhereItHoldsThereAndChasesNothing) {
  Hover hover;
  hover.moved_by_its_pilot(5.0, 3.0);
  const Vec3 there = hover.loop.vehicle.state().position_map;
  hover.loop.tracker.heard_vehicle(Control::goshawk, hover.now_ns);
  double farthest_m = 0.0;
  const std::int64_t begin_ns = hover.now_ns;
  while (hover.now_ns < begin_ns + 2 * kSecond) {
    const auto command = hover.loop.tracker.step(hover.loop.vehicle.state(), hover.now_ns);
    ASSERT_TRUE(command) << command.error().message;
    ASSERT_TRUE(hover.loop.vehicle.command(*command));
    ASSERT_TRUE(hover.loop.vehicle.advance(0.004));
    hover.now_ns += 4'000'000;
    const Vec3 off = hover.loop.vehicle.state().position_map - there;
    farthest_m = std::max(farthest_m, off.norm());
  }
  EXPECT_LT(farthest_m, 0.05);
  EXPECT_EQ(hover.loop.tracker.status().mode, Mode::hold);
  EXPECT_EQ(hover.loop.tracker.status().fault.code, ErrorCode::ok)
      << hover.loop.tracker.status().fault.message;
}

}  // namespace
}  // namespace goshawk::tracker
