#include "goshawk/px4_stand_in/autopilot.hpp"

#include <gtest/gtest.h>

#include <functional>
#include <optional>
#include <stdexcept>

#include "goshawk/px4_wire/codec.hpp"

namespace goshawk::px4_stand_in {
namespace {

using namespace px4;

constexpr std::int64_t kMs = 1'000'000;

struct Counter : Wire {
  void send(const VehicleStatus& m) override { ++statuses, status = m; }
  void send(const VehicleLandDetected&) override {}
  void send(const BatteryStatus&) override {}
  void send(const FailsafeFlags&) override {}
  void send(const ManualControlSetpoint&) override {}
  void send(const VehicleLocalPosition&) override { ++locals; }
  void send(const VehicleOdometry&) override { ++odometries; }
  void send(const VehicleCommandAck& m) override { ack = m; }
  void send(const MessageFormatResponse& m) override { format = m; }
  void send(const RegisterExtComponentReply& m) override { registered = m; }
  void send(const ArmingCheckRequest& m) override { ++requests, request = m; }
  void send(const SetpointConfigReply&) override {}

  int statuses = 0, locals = 0, odometries = 0, requests = 0;
  VehicleStatus status;
  ArmingCheckRequest request;
  std::optional<VehicleCommandAck> ack;
  std::optional<MessageFormatResponse> format;
  std::optional<RegisterExtComponentReply> registered;
};

class Autopilots : public testing::Test {
 protected:
  Autopilots() { config.failed_armings = 0; }

  void make() {
    auto made = Autopilot::create(config, wire, 0);
    if (!made) throw std::logic_error(made.error().message);
    autopilot.emplace(*std::move(made));
  }

  /// @param stream what is sent every 20 ms
  void run(double seconds, const std::function<void()>& stream = {}) {
    for (int i = 0; i < int(seconds / 0.02 + 0.5); ++i) {
      if (stream) stream();
      autopilot->advance(now_ns += 20 * kMs);
    }
  }

  std::uint8_t command(std::uint32_t what, double param1, std::uint8_t system = 1) {
    VehicleCommand m;
    m.command = what;
    m.param1 = float(param1);
    m.target_system = system;
    m.source_component = 191;
    wire.ack.reset();
    autopilot->hear(m);
    return wire.ack ? wire.ack->result : std::uint8_t(255);
  }

  void offboard() {
    OffboardControlMode alive;
    alive.position = true;
    autopilot->hear(alive);
    TrajectorySetpoint m;
    m.position = {0.0f, 3.0f, -1.5f};  // (3, 0, 1.5) of the map
    m.velocity = {0.0f, 0.0f, 0.0f};
    m.yaw = 1.57f;
    autopilot->hear(m);
  }

  void fly_offboard() {
    run(0.5, [&] { offboard(); });
    ASSERT_EQ(command(VehicleCommand::kSetNavState, nav_state::kOffboard), 0);
    ASSERT_EQ(command(VehicleCommand::kArm, 1), 0);
    run(12.0, [&] { offboard(); });
    ASSERT_NEAR(autopilot->truth().position_map.z(), 1.5, 0.1);
  }

  void register_mode() {
    RegisterExtComponentRequest m;
    m.request_id = 77;
    m.name = characters_of<25>("Goshawk");
    autopilot->hear(m);
  }

  void answer() {
    if (wire.requests == answered) return;
    answered = wire.requests;
    ArmingCheckReply reply;
    reply.request_id = wire.request.request_id;
    reply.registration_id = std::uint8_t(wire.registered->arming_check_id);
    reply.can_arm_and_run = true;
    autopilot->hear(reply);
  }

  Config config;
  Counter wire;
  std::optional<Autopilot> autopilot;
  std::int64_t now_ns = 0;
  int answered = 0;
};

TEST_F(Autopilots, SendsAtPx4sRates) {
  make();
  run(10.0);
  EXPECT_NEAR(wire.odometries, 1000, 20);
  EXPECT_NEAR(wire.locals, 500, 10);
  EXPECT_NEAR(wire.statuses, 20, 2);
  EXPECT_NEAR(wire.requests, 33, 2);
}

TEST_F(Autopilots, CommandsForAnotherSystemAreNotAnswered) {
  make();
  EXPECT_EQ(command(VehicleCommand::kSetNavState, nav_state::kHold, 9), 255);
  EXPECT_EQ(command(VehicleCommand::kSetNavState, nav_state::kHold, 0), 0);
  EXPECT_EQ(command(176, 1), 3);
}

TEST_F(Autopilots, AFirstArmingMayFail) {
  config.failed_armings = 2;
  make();
  EXPECT_EQ(command(VehicleCommand::kArm, 1), 1);
  EXPECT_EQ(command(VehicleCommand::kArm, 1), 1);
  EXPECT_EQ(command(VehicleCommand::kArm, 1), 0);
}

TEST_F(Autopilots, OffboardNeedsItsStream) {
  make();
  EXPECT_EQ(command(VehicleCommand::kSetNavState, nav_state::kOffboard), 0) << "disarmed: any mode";
  EXPECT_EQ(command(VehicleCommand::kArm, 1), 1);
  EXPECT_EQ(command(VehicleCommand::kSetNavState, nav_state::kHold), 0);
  EXPECT_EQ(command(VehicleCommand::kArm, 1), 0);
  EXPECT_EQ(command(VehicleCommand::kSetNavState, nav_state::kOffboard), 1) << "armed: refused";
}

TEST_F(Autopilots, ALostStreamIsNoticedAndPx4ReturnsByItself) {
  make();
  fly_offboard();
  run(config.offboard_loss_s - 0.04);
  EXPECT_EQ(autopilot->nav_state(), nav_state::kOffboard);
  run(0.1);
  EXPECT_EQ(autopilot->nav_state(), nav_state::kHold);
  EXPECT_TRUE(autopilot->failsafe());
  run(0.1, [&] { offboard(); });
  EXPECT_EQ(autopilot->nav_state(), nav_state::kOffboard);
  EXPECT_FALSE(autopilot->failsafe());
}

TEST_F(Autopilots, TheLastSetpointIsFollowedForEver) {
  make();
  fly_offboard();
  OffboardControlMode alive;
  alive.position = true;
  TrajectorySetpoint m;
  m.position = {kNan, kNan, kNan};
  m.velocity = {0.0f, 0.3f, 0.0f};  // to the east
  autopilot->hear(m);
  const double before = autopilot->truth().position_map.x();
  run(10.0, [&] { autopilot->hear(alive); });
  EXPECT_NEAR(autopilot->truth().position_map.x() - before, 3.0, 0.4);
}

TEST_F(Autopilots, ASetpointFromBeforeTheModeIsNotFlown) {
  make();
  fly_offboard();
  ASSERT_EQ(command(VehicleCommand::kSetNavState, nav_state::kHold), 0);
  TrajectorySetpoint m;
  m.position = {5.0f, 3.0f, -1.5f};
  autopilot->hear(m);
  OffboardControlMode alive;
  alive.position = true;
  run(1.0, [&] { autopilot->hear(alive); });
  ASSERT_EQ(command(VehicleCommand::kSetNavState, nav_state::kOffboard), 0);
  const Vec3 place = autopilot->truth().position_map;
  run(3.0, [&] { autopilot->hear(alive); });
  EXPECT_LT((autopilot->truth().position_map - place).norm(), 0.05);
}

TEST_F(Autopilots, InTheAirItDoesNotDisarmAndAfterALandingItDoes) {
  make();
  fly_offboard();
  EXPECT_EQ(command(VehicleCommand::kArm, 0), 1);
  EXPECT_TRUE(autopilot->armed());
  ASSERT_EQ(command(VehicleCommand::kSetNavState, nav_state::kLand), 0);
  run(4.0);
  EXPECT_TRUE(autopilot->landed());
  EXPECT_LT(autopilot->touched_m_s(), 1.0);
  run(3.0);
  EXPECT_FALSE(autopilot->armed());
}

TEST_F(Autopilots, WithoutATakeoffItDisarms) {
  make();
  ASSERT_EQ(command(VehicleCommand::kArm, 1), 0);
  run(10.5);
  EXPECT_TRUE(autopilot->armed());
  run(1.0);
  EXPECT_FALSE(autopilot->armed());
}

TEST_F(Autopilots, AModeOfAnotherProgramCannotLeaveTheGround) {
  make();
  register_mode();
  ASSERT_TRUE(wire.registered && wire.registered->success);
  run(1.0, [&] { answer(); });
  ASSERT_EQ(command(VehicleCommand::kSetNavState, double(wire.registered->mode_id)), 0);
  ASSERT_EQ(command(VehicleCommand::kArm, 1), 0);
  run(9.0, [&] { answer(), offboard(); });
  EXPECT_TRUE(autopilot->landed());
  EXPECT_NEAR(autopilot->truth().position_map.z(), ground_z_m(config), 1e-9);
}

TEST_F(Autopilots, AnUnresponsiveModeIsLandedAfterAboutASecond) {
  make();
  register_mode();
  run(1.0, [&] { answer(); });
  ASSERT_EQ(command(VehicleCommand::kSetNavState, nav_state::kTakeoff), 0);
  ASSERT_EQ(command(VehicleCommand::kArm, 1), 0);
  run(12.0, [&] { answer(); });
  ASSERT_EQ(autopilot->nav_state(), nav_state::kHold) << "Takeoff ends in Hold";
  ASSERT_EQ(command(VehicleCommand::kSetNavState, double(wire.registered->mode_id)), 0);
  run(1.0, [&] { answer(), offboard(); });
  ASSERT_EQ(autopilot->nav_state(), nav_state::kExternal1);
  run(0.9);
  EXPECT_EQ(autopilot->nav_state(), nav_state::kExternal1);
  run(0.45);
  EXPECT_EQ(autopilot->nav_state(), nav_state::kLand);
  EXPECT_TRUE(autopilot->failsafe());
}

TEST_F(Autopilots, RegistrationIsRefusedWhenArmedAndWhenTheSlotIsTaken) {
  make();
  ASSERT_EQ(command(VehicleCommand::kArm, 1), 0);
  register_mode();
  EXPECT_FALSE(wire.registered->success);
  ASSERT_EQ(command(VehicleCommand::kArm, 0), 0);
  register_mode();
  EXPECT_TRUE(wire.registered->success);
  EXPECT_EQ(wire.registered->request_id, 77u);
  register_mode();
  EXPECT_FALSE(wire.registered->success);
}

TEST_F(Autopilots, AnswersWhatItsMessagesAreLike) {
  make();
  MessageFormatRequest m;
  m.topic_name = characters_of<50>("/fmu/out/vehicle_status");
  autopilot->hear(m);
  ASSERT_TRUE(wire.format && wire.format->success);
  EXPECT_EQ(wire.format->message_hash, 0xf779fa65u);
  m.topic_name = characters_of<50>("/fmu/out/no_such_topic");
  autopilot->hear(m);
  EXPECT_FALSE(wire.format->success);
}

TEST_F(Autopilots, AnImpossibleVehicleIsRefused) {
  config.vehicle.vehicle.mass_kg = -1.0;
  EXPECT_EQ(Autopilot::create(config, wire, 0).code(), ErrorCode::invalid_parameter);
}

}  // namespace
}  // namespace goshawk::px4_stand_in
