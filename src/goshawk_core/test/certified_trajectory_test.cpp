#include "goshawk/core/certified_trajectory.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <type_traits>

namespace goshawk {
namespace {

// From rest to rest over a metre, in a box.
struct Line {
  FlatState start;
  FlatState goal;
  Trajectory trajectory;
  std::vector<Polytope> polytopes{Polytope::box(Vec3(-1, -1, -1), Vec3(2, 1, 1))};
  Limits limits;

  Line() {
    goal.position = Vec3(1, 0, 0);
    trajectory.pieces = {BezierPiece::between(start, goal, 4.0)};
  }
  Result<CertifiedTrajectory> certified() const {
    return certify(trajectory, polytopes, limits, start, goal);
  }
};

TEST(CertifiedTrajectory, OnlyCertifyMakesOne) {
  static_assert(!std::is_default_constructible_v<CertifiedTrajectory>);
  static_assert(!std::is_aggregate_v<CertifiedTrajectory>);
  static_assert(std::is_copy_constructible_v<CertifiedTrajectory>);
}

TEST(CertifiedTrajectory, KeepsWhatWasProved) {
  const Line line;
  const auto certified = line.certified();
  ASSERT_TRUE(certified.ok()) << certified.error().message;
  EXPECT_TRUE(certified->certificate().holds());
  EXPECT_LT(certified->certificate().position_m, 0.0);
  EXPECT_EQ(certified->trajectory().pieces[0].control_points,
            line.trajectory.pieces[0].control_points);
  EXPECT_EQ(certified->polytopes(), line.polytopes);
  EXPECT_EQ(certified->limits().v_max_m_s, line.limits.v_max_m_s);
  EXPECT_EQ(certified->goal().position, line.goal.position);
  EXPECT_DOUBLE_EQ(certified->duration_s(), 4.0);
  EXPECT_TRUE(certified->ends_at_rest());
}

TEST(CertifiedTrajectory, MayEndInMotionAndSaysSo) {
  Line line;
  line.goal.velocity = Vec3(0.5, 0, 0);
  line.trajectory.pieces = {BezierPiece::between(line.start, line.goal, 4.0)};
  const auto certified = line.certified();
  ASSERT_TRUE(certified.ok()) << certified.error().message;
  EXPECT_FALSE(certified->ends_at_rest());
}

TEST(CertifiedTrajectory, IsNotMadeOfWhatDoesNotHold) {
  const auto refused = [](auto&& harm, const char* family) {
    Line line;
    harm(line);
    const auto certified = line.certified();
    ASSERT_EQ(certified.code(), ErrorCode::not_certified) << family;
    EXPECT_NE(certified.error().message.find(family), std::string::npos)
        << certified.error().message;
  };
  refused([](Line& l) { l.polytopes[0].half_spaces[0].offset_m = 0.5; }, "position");
  refused([](Line& l) { l.limits.v_max_m_s = 0.1; }, "velocity");
  refused([](Line& l) { l.limits.a_max_m_s2 = 0.01; }, "acceleration");
  refused([](Line& l) { l.limits.j_max_m_s3 = 0.1; }, "jerk");
  refused([](Line& l) { l.start.velocity.x() = 0.5; }, "start");
  refused([](Line& l) { l.goal.position.x() = 1.5; }, "goal");
  refused([](Line& l) { l.polytopes[0].valid_until_s = 3.0; }, "validity");
}

TEST(CertifiedTrajectory, IsNotMadeOfNonsense) {
  const auto code = [](auto&& harm) {
    Line line;
    harm(line);
    return line.certified().code();
  };
  EXPECT_EQ(code([](Line& l) { l.trajectory.pieces.clear(); }), ErrorCode::invalid_input);
  EXPECT_EQ(code([](Line& l) { l.trajectory.pieces[0].duration_s = 0.0; }),
            ErrorCode::invalid_input);
  EXPECT_EQ(code([](Line& l) { l.trajectory.pieces[0].control_points(0, 0) = NAN; }),
            ErrorCode::invalid_input);
  EXPECT_EQ(code([](Line& l) { l.trajectory.pieces[0].polytope = 1; }), ErrorCode::invalid_input);
  EXPECT_EQ(code([](Line& l) { l.trajectory.pieces[0].polytope = -1; }), ErrorCode::invalid_input);
  EXPECT_EQ(code([](Line& l) { l.polytopes.clear(); }), ErrorCode::invalid_input);
  EXPECT_EQ(code([](Line& l) { l.polytopes.emplace_back(); }), ErrorCode::invalid_input)
      << "a polytope that no piece uses must be valid as well";
  EXPECT_EQ(code([](Line& l) { l.start.position.x() = NAN; }), ErrorCode::invalid_input);
  EXPECT_EQ(code([](Line& l) { l.goal.acceleration.z() = INFINITY; }), ErrorCode::invalid_input);
  EXPECT_EQ(code([](Line& l) { l.limits.v_max_m_s = -1.0; }), ErrorCode::invalid_limits);
}

}  // namespace
}  // namespace goshawk
