#include "goshawk/px4/bridge.hpp"

#include <gtest/gtest.h>

#include <optional>

#include "goshawk/px4_wire/codec.hpp"
#include "recorder.hpp"

namespace goshawk::px4 {
namespace {

constexpr std::int64_t kMs = 1'000'000;

/// A PX4 of which the test says what it sends. It stands still at (0, 0, 1) of the map.
class Bridges : public testing::Test {
 protected:
  Bridges() {
    status.arming_state = VehicleStatus::kDisarmed;
    status.nav_state = nav_state::kPosition;
    status.vehicle_type = VehicleStatus::kRotary;
    status.system_id = 5;
    status.component_id = 1;
    local.xy_valid = local.z_valid = local.v_xy_valid = local.v_z_valid = true;
    local.heading_good_for_control = true;
    local.x = local.y = 0.0f;
    local.z = -1.0f;
    odometry.position = {0.0f, 0.0f, -1.0f};
    odometry.q = {1.0f, 0.0f, 0.0f, 0.0f};
    odometry.velocity = odometry.angular_velocity = {0.0f, 0.0f, 0.0f};
    odometry.position_variance = {1e-4f, 1e-4f, 1e-4f};
  }

  void make(Takeoff takeoff = Takeoff::pilot) {
    config.takeoff = takeoff;
    bridge.emplace(config, link, 1);
  }

  /// Time passes; PX4 sends, and answers what it is asked of its formats.
  void run(double seconds) {
    for (int i = 0; i < int(seconds / 0.02); ++i) {
      now_ns += 20 * kMs;
      local.timestamp_sample = odometry.timestamp_sample = std::uint64_t(now_ns) / 1000;
      bridge->hear(status, now_ns);
      bridge->hear(VehicleLandDetected{landed});
      bridge->hear(local, now_ns);
      given = bridge->hear(odometry, now_ns);
      bridge->step(now_ns);
      answer_formats();
    }
  }

  void answer_formats() {
    if (link.formats.size() == answered) return;
    answered = link.formats.size();
    MessageFormatResponse response;
    response.topic_name = link.formats.back().topic_name;
    response.success = true;
    const std::string topic = text_of(response.topic_name).substr(5);  // behind /fmu/
    response.message_hash =
        hash_of<VehicleStatus, VehicleOdometry, VehicleLocalPosition, VehicleLandDetected,
                BatteryStatus, FailsafeFlags, VehicleCommandAck, VehicleCommand, TrajectorySetpoint,
                VehicleAttitudeSetpoint, OffboardControlMode>(topic);
    bridge->hear(response);
  }

  template <typename... Messages>
  std::uint32_t hash_of(const std::string& topic) const {
    std::uint32_t hash = 0;
    ((Messages::kTopic == topic ? void(hash = definition_of(Messages::kType, speaks).layout.hash())
                                : void()),
     ...);
    return hash;
  }

  void fly() {
    status.arming_state = VehicleStatus::kArmed;
    landed = false;
    run(4.0);
    status.nav_state = nav_state::kOffboard;
    run(0.1);
    ASSERT_EQ(bridge->phase(), Phase::flying);
  }

  Config config;
  Recorder link;
  std::optional<Bridge> bridge;
  Release speaks = Release::v1_17;
  VehicleStatus status;
  VehicleLocalPosition local;
  VehicleOdometry odometry;
  bool landed = true;
  std::int64_t now_ns = 1000 * kMs;
  std::size_t answered = 0;
  std::optional<TimedState> given;
};

TEST_F(Bridges, AnotherReleaseIsRefusedForEver) {
  speaks = Release::v1_18;
  make(Takeoff::automatic);
  run(20.0);
  EXPECT_EQ(bridge->phase(), Phase::refused);
  EXPECT_TRUE(link.told_of("set px4_release to 1.18"));
  EXPECT_TRUE(link.commands.empty());
  EXPECT_TRUE(link.alive.empty());
  EXPECT_TRUE(link.trajectories.empty());
}

TEST_F(Bridges, APilotsVehicleIsNeverArmedNorSwitched) {
  make();
  run(30.0);
  EXPECT_EQ(bridge->phase(), Phase::waiting);
  EXPECT_TRUE(link.commands.empty());
  EXPECT_TRUE(link.trajectories.empty());
  EXPECT_FALSE(link.alive.empty());  // so that Offboard can be selected
  EXPECT_FALSE(given) << "on the ground no odometry goes to the stages";
}

TEST_F(Bridges, FliesWhenItsModeIsSelectedInTheAir) {
  make();
  fly();
  EXPECT_TRUE(bridge->ready());
  EXPECT_EQ(bridge->in_charge(), InCharge::goshawk);
  ASSERT_FALSE(link.trajectories.empty());
  EXPECT_EQ(link.trajectories.back().position, (Vec3f{0.0f, 0.0f, -1.0f}));
  ASSERT_TRUE(given);
  EXPECT_LT((given->state.position_map - Vec3(0, 0, 1)).norm(), 1e-6);
}

TEST_F(Bridges, ThePilotAndTheGroundStationWin) {
  make();
  fly();
  status.nav_state = nav_state::kPosition;
  bridge->hear(ManualControlSetpoint{true, true});
  run(0.1);
  const auto sent = link.trajectories.size();
  run(5.0);
  EXPECT_EQ(bridge->phase(), Phase::waiting);
  EXPECT_EQ(bridge->in_charge(), InCharge::pilot);
  EXPECT_TRUE(link.told_of("the pilot moved the sticks"));
  EXPECT_EQ(link.trajectories.size(), sent);
  EXPECT_TRUE(link.commands.empty());
  // It flies again when somebody selects its mode.
  status.nav_state = nav_state::kOffboard;
  run(0.1);
  EXPECT_EQ(bridge->phase(), Phase::flying);
}

TEST_F(Bridges, AFailsafeIsNamedAndNotFought) {
  make();
  fly();
  status.nav_state = nav_state::kLand;
  status.failsafe = true;
  run(3.0);
  EXPECT_TRUE(link.told_of("PX4's failsafe has the vehicle, in Land"));
  EXPECT_TRUE(link.commands.empty());
}

TEST_F(Bridges, ASmallResetMovesTheSetpointsWithTheFrame) {
  make();
  fly();
  local.x = odometry.position[0] = 0.2f;
  local.delta_xy = {0.2f, 0.0f};
  local.xy_reset_counter = odometry.reset_counter = 1;
  run(0.1);
  EXPECT_EQ(bridge->phase(), Phase::flying);
  EXPECT_NEAR(link.trajectories.back().position[0], 0.2, 1e-6);
  ASSERT_TRUE(given);
  EXPECT_LT((given->state.position_map - Vec3(0, 0, 1)).norm(), 1e-6);
  EXPECT_EQ(bridge->resets(), 1u);
}

TEST_F(Bridges, ALargeResetGoesToPx4sHold) {
  make();
  fly();
  local.x = odometry.position[0] = 5.0f;
  local.delta_xy = {5.0f, 0.0f};
  local.xy_reset_counter = odometry.reset_counter = 1;
  run(0.1);
  const auto alive = link.alive.size();
  run(1.0);
  EXPECT_EQ(bridge->phase(), Phase::waiting);
  EXPECT_TRUE(link.told_of("control goes to PX4's own Hold"));
  EXPECT_EQ(link.alive.size(), alive) << "without the stream PX4 leaves Offboard by itself";
  ASSERT_FALSE(link.commands.empty());
  EXPECT_EQ(link.commands.back().command, VehicleCommand::kSetNavState);
  EXPECT_EQ(link.commands.back().param1, float(nav_state::kHold));
  EXPECT_EQ(link.commands.back().target_system, 5);
  EXPECT_TRUE(link.commands.back().from_external);
}

TEST_F(Bridges, ResetsThatWereMissedEndGoshawksFlights) {
  make();
  fly();
  local.xy_reset_counter = 3;
  run(0.1);
  status.nav_state = nav_state::kHold;
  run(0.1);
  status.nav_state = nav_state::kOffboard;
  run(1.0);
  EXPECT_EQ(bridge->phase(), Phase::waiting);
  EXPECT_FALSE(given);
}

TEST_F(Bridges, AnUncertaintyThatVariesIsSaidOnceASecondAtTheMost) {
  make();
  fly();
  const auto before = link.told.size();
  for (int i = 0; i < 200; ++i) {  // 4 s
    odometry.position_variance[0] = 0.1f + 0.01f * float(i);
    run(0.02);
  }
  EXPECT_TRUE(link.told_of("max_position_deviation_m"));
  EXPECT_LE(link.told.size() - before, 5u);
  EXPECT_FALSE(given);
}

TEST_F(Bridges, ACriticalBatteryDoesNotStart) {
  make(Takeoff::automatic);
  bridge->hear(BatteryStatus{true, 0.05f, BatteryStatus::kCritical});
  run(30.0);
  EXPECT_TRUE(link.commands.empty());
  EXPECT_TRUE(link.told_of("battery is critical"));
}

TEST_F(Bridges, StartsAutomaticallyOnlyOnceAndOnlyFromTheGround) {
  make(Takeoff::automatic);
  run(10.0);
  ASSERT_FALSE(link.commands.empty());
  EXPECT_EQ(link.commands.front().command, VehicleCommand::kSetNavState);
  EXPECT_EQ(link.commands.front().param1, float(nav_state::kOffboard));
  status.nav_state = nav_state::kOffboard;
  run(2.0);
  EXPECT_EQ(link.commands.back().command, VehicleCommand::kArm);
  run(120.0);  // PX4 does not arm
  EXPECT_TRUE(link.told_of("PX4 did not arm"));
  const auto asked = link.commands.size();
  run(60.0);
  EXPECT_EQ(link.commands.size(), asked);
}

TEST_F(Bridges, WhoFliesAlreadyIsNotStarted) {
  make(Takeoff::automatic);
  status.arming_state = VehicleStatus::kArmed;
  landed = false;
  run(20.0);
  status.arming_state = VehicleStatus::kDisarmed;
  landed = true;
  run(20.0);
  EXPECT_TRUE(link.commands.empty());
}

TEST_F(Bridges, APx4ThatDoesNotAnswerIsSaid) {
  make();
  for (int i = 0; i < 500; ++i) bridge->step(now_ns += 20 * kMs);
  EXPECT_EQ(bridge->phase(), Phase::checking);
  EXPECT_TRUE(link.told_of("Micro-XRCE-DDS agent"));
}

TEST_F(Bridges, ASilentTrackerIsHandedOverAfterItsStop) {
  make();
  fly();
  bridge->hear(FallbackStop{.step_s = 0.1, .states = {{.position = {0, 0, 1}}}}, now_ns);
  run(config.hand_over_after_s - 1.0);
  EXPECT_EQ(bridge->phase(), Phase::flying);
  EXPECT_TRUE(link.told_of("the tracker fell silent"));
  run(2.0);
  EXPECT_EQ(bridge->phase(), Phase::waiting);
  EXPECT_EQ(link.commands.back().param1, float(nav_state::kHold));
}

TEST_F(Bridges, AReferenceThatRestsOnTheGroundIsLandedByPx4) {
  config.land_height_m = 1.0;
  make();
  fly();
  bridge->hear(FallbackStop{.step_s = 0.1, .states = {{.position = {0, 0, 1}}}}, now_ns);
  run(0.1);
  EXPECT_EQ(bridge->phase(), Phase::landing);
  EXPECT_EQ(link.commands.back().param1, float(nav_state::kLand));
  status.nav_state = nav_state::kLand;
  run(0.1);
  const auto sent = link.trajectories.size() + link.alive.size();
  run(2.0);
  EXPECT_EQ(link.trajectories.size() + link.alive.size(), sent);
  status.arming_state = VehicleStatus::kDisarmed;
  run(0.1);
  EXPECT_TRUE(link.told_of("landed and disarmed"));
}

TEST_F(Bridges, AtTheLevelOfAttitudesTheTrackersCommandIsSent) {
  config.setpoint = SetpointLevel::attitude;
  make();
  speaks = Release::v1_17;
  fly();
  const AttitudeSetpoint command{config.mass_kg * kGravity_m_s2, Quaternion::Identity(),
                                 Vec3::Zero()};
  bridge->hear(command, now_ns);
  ASSERT_EQ(link.attitudes.size(), 1u);
  EXPECT_NEAR(link.attitudes.back().thrust_body[2], -config.hover_thrust, 1e-6);
  // A tracker that falls silent: its stop is flown by PX4's position controller.
  run(1.0);
  EXPECT_TRUE(link.alive.back().position);
  EXPECT_FALSE(link.alive.back().attitude);
}

}  // namespace
}  // namespace goshawk::px4
