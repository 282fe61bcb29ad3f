#include "goshawk/core/committed_trajectory.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace goshawk {
namespace {

const std::vector<Polytope> kRoom{Polytope::box(Vec3::Constant(-9), Vec3::Constant(9))};

CertifiedTrajectory certified(const FlatState& from, const FlatState& to, double duration_s) {
  Trajectory trajectory{{BezierPiece::between(from, to, duration_s)}};
  return certify(std::move(trajectory), kRoom, Limits{.v_max_m_s = 5.0, .a_max_m_s2 = 50.0}, from,
                 to)
      .value();
}

FlatState at(double x, double v = 0.0) {
  FlatState state;
  state.position.x() = x;
  state.velocity.x() = v;
  return state;
}

// To rest within a second, from where the nominal part is after after_s.
StopPart stop_of(const CertifiedTrajectory& nominal, double after_s) {
  FlatState from = nominal.trajectory().sample(after_s);
  from.jerk.setZero();
  FlatState to;
  to.position = from.position + 0.5 * from.velocity;
  return {after_s, certified(from, to, 1.0)};
}

TEST(CommittedTrajectory, WithoutAStopPartFliesTheNominalPart) {
  Commitment content{.id = 3, .nominal = certified(at(0), at(2), 4.0), .start_time_ns = 17};
  content.map_version = 8;
  content.yaw_rad = 0.5;
  const auto committed = CommittedTrajectory::make(std::move(content));
  ASSERT_TRUE(committed.ok()) << committed.error().message;
  EXPECT_EQ(committed->id(), 3u);
  EXPECT_EQ(committed->start_time_ns(), 17);
  EXPECT_EQ(committed->map_version(), 8u);
  EXPECT_FALSE(committed->stop().has_value());
  EXPECT_EQ(&committed->flown(), &committed->nominal().trajectory());
  EXPECT_EQ(committed->flown_polytopes(), kRoom);
  EXPECT_EQ(committed->yaw_at(1.0), 0.5);
}

TEST(CommittedTrajectory, WithAStopPartFliesTheNominalPartUntilItBegins) {
  const auto nominal = certified(at(0), at(4, 1.0), 4.0);
  ASSERT_FALSE(nominal.ends_at_rest());
  const auto committed =
      CommittedTrajectory::make({.id = 1, .nominal = nominal, .stop = stop_of(nominal, 1.5)});
  ASSERT_TRUE(committed.ok()) << committed.error().message;
  const Trajectory& flown = committed->flown();
  EXPECT_NEAR(flown.duration_s(), 2.5, 1e-12);
  for (double t = 0.0; t <= 1.5; t += 0.1) {
    EXPECT_LT(largest_difference(flown.sample(t), nominal.trajectory().sample(t)), 1e-12) << t;
  }
  for (double t = 1.51; t <= 2.5; t += 0.1) {
    const auto stop = committed->stop()->trajectory.trajectory().sample(t - 1.5);
    EXPECT_LT(largest_difference(flown.sample(t), stop), 1e-12) << t;
  }
  ASSERT_EQ(flown.pieces.size(), 2u);
  EXPECT_EQ(flown.pieces[0].polytope, 0);
  EXPECT_EQ(flown.pieces[1].polytope, 1) << "after the nominal part's polytopes";
  EXPECT_EQ(committed->flown_polytopes(), (std::vector{kRoom[0], kRoom[0]}));
}

TEST(CommittedTrajectory, MustEndAtRest) {
  const auto moving = certified(at(0), at(4, 1.0), 4.0);
  const auto nominal = CommittedTrajectory::make({.id = 5, .nominal = moving});
  ASSERT_EQ(nominal.code(), ErrorCode::not_certified);
  EXPECT_NE(nominal.error().message.find("trajectory 5 refused: it does not end at rest"),
            std::string::npos)
      << nominal.error().message;
  const FlatState from = moving.trajectory().sample(2.0);
  const StopPart goes_on{2.0, certified(from, at(6, 1.0), 3.0)};
  EXPECT_EQ(CommittedTrajectory::make({.nominal = moving, .stop = goes_on}).code(),
            ErrorCode::not_certified);
}

TEST(CommittedTrajectory, MustPassFromTheNominalToTheStopPartWithoutAJump) {
  const auto nominal = certified(at(0), at(4), 4.0);
  StopPart stop = stop_of(nominal, 1.5);
  for (const double after_s : {1.4999, 1.51, 3.0}) {
    stop.after_s = after_s;
    EXPECT_EQ(CommittedTrajectory::make({.nominal = nominal, .stop = stop}).code(),
              ErrorCode::not_certified)
        << after_s;
  }
  for (const double after_s : {0.0, -1.0, 4.5, double(NAN)}) {
    stop.after_s = after_s;
    EXPECT_EQ(CommittedTrajectory::make({.nominal = nominal, .stop = stop}).code(),
              ErrorCode::invalid_input)
        << after_s;
  }
}

TEST(CommittedTrajectory, TurnsByItsYawCurve) {
  const auto nominal = certified(at(0), at(2), 4.0);
  const auto committed = CommittedTrajectory::make(
      {.nominal = nominal, .yaw_rad = 9.0, .yaw_curve = YawCurve{4.0, {0.0, 2.0, 4.0}}});
  ASSERT_TRUE(committed.ok());
  EXPECT_DOUBLE_EQ(committed->yaw_at(0.0), 1.0);
  EXPECT_DOUBLE_EQ(committed->yaw_at(2.0), 2.0);
  EXPECT_DOUBLE_EQ(committed->yaw_at(99.0), 3.0);
}

TEST(CommittedTrajectory, IsRefusedWithYawOrTimeOutOfRange) {
  const auto nominal = certified(at(0), at(2), 4.0);
  const auto code = [&](auto&& harm) {
    Commitment content{.nominal = nominal};
    harm(content);
    return CommittedTrajectory::make(std::move(content)).code();
  };
  EXPECT_EQ(code([](Commitment&) {}), ErrorCode::ok);
  EXPECT_EQ(code([](Commitment& c) { c.yaw_rad = NAN; }), ErrorCode::invalid_input);
  EXPECT_EQ(code([](Commitment& c) { c.yaw_curve = YawCurve{}; }), ErrorCode::invalid_input);
  EXPECT_EQ(code([](Commitment& c) { c.start_time_ns = std::numeric_limits<std::int64_t>::min(); }),
            ErrorCode::invalid_input);
}

}  // namespace
}  // namespace goshawk
