#include "goshawk/flight_check/planned_track.hpp"

#include <gtest/gtest.h>

#include "worlds.hpp"

namespace goshawk::flight_check::test {
namespace {

PlannedPiece line(const Vec3& from, const Vec3& to, double duration_s) {
  PlannedPiece piece;
  for (int i = 0; i < 6; ++i)
    piece.control_points_map[std::size_t(i)] = from + (to - from) * i / 5.0;
  piece.duration_s = duration_s;
  return piece;
}

/// The quintic's Bernstein form, written out.
Vec3 bernstein(const PlannedPiece& piece, double u) {
  constexpr double kChoose[] = {1, 5, 10, 10, 5, 1};
  Vec3 sum = Vec3::Zero();
  for (int i = 0; i < 6; ++i) {
    sum += kChoose[i] * std::pow(u, i) * std::pow(1 - u, 5 - i) *
           piece.control_points_map[std::size_t(i)];
  }
  return sum;
}

TEST(PlannedTrack, FollowsTheCurveAndItsTimes) {
  Random random(5);
  for (int k = 0; k < 50; ++k) {
    PlannedPiece piece;
    for (auto& p : piece.control_points_map) {
      p = Vec3(random.uniform(-2, 2), random.uniform(-2, 2), random.uniform(-2, 2));
    }
    piece.duration_s = random.uniform(0.2, 4.0);
    const auto track = planned_track(std::span(&piece, 1), 0.05).value();
    ASSERT_GE(track.size(), 5U);
    EXPECT_EQ(track.front().t_s, 0.0);
    EXPECT_NEAR(track.back().t_s, piece.duration_s, 1e-12);
    for (std::size_t i = 0; i < track.size(); ++i) {
      const double u = track[i].t_s / piece.duration_s;
      EXPECT_LT((track[i].position_map - bernstein(piece, u)).norm(), 1e-12);
      EXPECT_LE(i > 0 ? track[i].t_s - track[i - 1].t_s : 0.0, 0.05 + 1e-12);
      // Attitude: the body's z axis along acceleration (by central differences) plus gravity.
      const double h = 1e-4;
      const Vec3 a = (bernstein(piece, u + h) - 2 * bernstein(piece, u) + bernstein(piece, u - h)) /
                     (h * h * piece.duration_s * piece.duration_s);
      const Vec3 thrust = (a + Vec3(0, 0, 9.80665)).normalized();
      EXPECT_LT((track[i].q_map_base * Vec3::UnitZ() - thrust).norm(), 1e-3);
      EXPECT_NEAR(track[i].q_map_base.norm(), 1.0, 1e-12);
    }
  }
}

TEST(PlannedTrack, KeepsTheYawAndJoinsPieces) {
  const std::vector<PlannedPiece> pieces{line({0, 0, 1}, {1, 0, 1}, 0.5),
                                         line({1, 0, 1}, {1, 1, 1}, 0.7)};
  const auto track = planned_track(pieces, 0.1, [](double) { return 0.8; }).value();
  EXPECT_EQ(track.size(), 1U + 5U + 7U);
  EXPECT_NEAR(track.back().t_s, 1.2, 1e-12);
  for (const Sample& s : track) {
    EXPECT_LT((s.q_map_base * Vec3::UnitX() - Vec3(std::cos(0.8), std::sin(0.8), 0)).norm(), 1e-9);
  }
}

TEST(PlannedTrack, TurnsAsItsYawIsPlanned) {
  const std::vector<PlannedPiece> pieces{line({0, 0, 1}, {1, 0, 1}, 0.5),
                                         line({1, 0, 1}, {1, 1, 1}, 0.7)};
  const auto turning = [](double t_s) { return 2.0 * t_s - 0.5; };
  const auto track = planned_track(pieces, 0.1, turning).value();
  ASSERT_EQ(track.size(), 13U);
  for (const Sample& s : track) {
    const Vec3 heading = s.q_map_base * Vec3::UnitX();
    EXPECT_NEAR(std::atan2(heading.y(), heading.x()), turning(s.t_s), 1e-9) << s.t_s;
  }
  const auto lost = [](double t_s) { return t_s < 0.6 ? 0.0 : NAN; };
  EXPECT_EQ(planned_track(pieces, 0.1, lost).code(), ErrorCode::invalid_input);
}

TEST(PlannedTrack, CountsFromItsStart) {
  const auto turning = [](double t_s) { return t_s; };
  const auto track =
      planned_track(std::vector{line({0, 0, 1}, {1, 0, 1}, 0.5)}, 0.1, turning, 1.25).value();
  EXPECT_DOUBLE_EQ(track.front().t_s, 1.25);
  EXPECT_NEAR(track.back().t_s, 1.75, 1e-12);
  for (const Sample& s : track) {
    const Vec3 heading = s.q_map_base * Vec3::UnitX();
    EXPECT_NEAR(std::atan2(heading.y(), heading.x()), s.t_s, 1e-9);
  }
}

TEST(PlannedTrack, IsJudgedLikeAFlownOne) {
  const std::vector<PlannedPiece> pieces{line({-2, 0, 0.05}, {2, 0, 0.05}, 2.0)};
  const auto track = planned_track(pieces).value();
  EXPECT_TRUE(judge(tree_of({{5, 0, 0}}), track).touched);
  EXPECT_NEAR(judge(tree_of({{5, 4, 0}}), track).clearance_m, 0.4 - 0.15, 1e-3);
}

TEST(PlannedTrack, RefusesWhatIsNoTrajectory) {
  const auto code = [](const std::vector<PlannedPiece>& pieces, double step_s = 0.01) {
    return planned_track(pieces, step_s).code();
  };
  const auto good = line({0, 0, 0}, {1, 0, 0}, 1.0);
  EXPECT_EQ(code({}), ErrorCode::invalid_input);
  EXPECT_EQ(code({line({0, 0, 0}, {1, 0, 0}, 0.0)}), ErrorCode::invalid_input);
  EXPECT_EQ(code({line({0, 0, 0}, {1, 0, 0}, NAN)}), ErrorCode::invalid_input);
  EXPECT_EQ(code({line({0, 0, 0}, {NAN, 0, 0}, 1.0)}), ErrorCode::invalid_input);
  EXPECT_EQ(code({good}, 0.0), ErrorCode::invalid_input);
  EXPECT_EQ(code({good}, 1e-9), ErrorCode::invalid_input);
  EXPECT_EQ(code({good}), ErrorCode::ok);
  EXPECT_EQ(planned_track(std::vector{good}, 0.01, {}, NAN).code(), ErrorCode::invalid_input);
}

}  // namespace
}  // namespace goshawk::flight_check::test
