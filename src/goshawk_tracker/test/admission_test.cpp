#include "goshawk/tracker/admission.hpp"

#include <gmock/gmock.h>

#include "trajectories.hpp"

namespace goshawk::tracker {
namespace {

using testing::HasSubstr;

Draft good() {
  Random random(1);
  return random_trajectory(random, {0, 0, 1}, 4, 1.5, 1.5);
}

TEST(Admission, ATrajectoryThatTheVehicleCanFlyIsAdmitted) {
  const auto status = admit(good(), Config{});
  EXPECT_TRUE(status) << status.error().message;
}

TEST(Admission, ThrustOrTiltBeyondTheTrackersBoundsIsRefusedWithTheWayOut) {
  auto draft = good();
  for (auto& piece : draft.trajectory.pieces) piece.duration_s *= 0.3;
  certify_as_is(draft);
  const auto status = admit(draft, Config{});
  ASSERT_FALSE(status);
  EXPECT_EQ(status.code(), ErrorCode::trajectory_infeasible);
  EXPECT_THAT(status.error().message, HasSubstr("lower a_max"));
  EXPECT_THAT(status.error().message, HasSubstr("trajectory " + std::to_string(draft.id)));
}

TEST(Admission, MorePiecesThanAControlStepCanLookThroughAreRefused) {
  const auto hover = [](std::size_t pieces) {
    Draft draft;
    draft.trajectory.pieces.assign(pieces, BezierPiece::between({}, {}, 0.01));
    certify_as_is(draft);
    draft.limits = {1.0, 1.0};
    return draft;
  };
  EXPECT_TRUE(admit(hover(4096), Config{}));
  EXPECT_EQ(admit(hover(4097), Config{}).code(), ErrorCode::invalid_input);
}

TEST(Admission, FallingFasterThanTheLeastThrustAllowsIsRefused) {
  auto draft = straight_line({0, 0, 30}, {0, 0, 1}, 3.5);
  EXPECT_EQ(admit(draft, Config{}).code(), ErrorCode::trajectory_infeasible);
  draft = straight_line({0, 0, 30}, {0, 0, 1}, 9.0);
  EXPECT_TRUE(admit(draft, Config{}));
}

}  // namespace
}  // namespace goshawk::tracker
