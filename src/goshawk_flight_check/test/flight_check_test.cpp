// Whole flights: nothing between two samples escapes.
#include "goshawk/flight_check/flight_check.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "worlds.hpp"

namespace goshawk::flight_check::test {
namespace {

TEST(FlightCheck, FindsTheSmallestClearanceOfAPassWithItsTimeAndPlace) {
  // Flies along y past a voxel of which the near edge is at x = 1; nearest when abreast.
  const auto v =
      judge(tree_of({{10, 0, 0}}), {at(2.0, Vec3(0.5, -2.0, 0.05)), at(6.0, Vec3(0.5, 2.0, 0.05))});
  EXPECT_FALSE(v.touched);
  EXPECT_NEAR(v.clearance_m, 0.5 - 0.15, 1e-3);
  EXPECT_NEAR(v.clearance_place_map.x(), 1.0, 0.02);
  EXPECT_GT(v.clearance_t_s, 3.9);
  EXPECT_LT(v.clearance_t_s, 4.2);
  EXPECT_EQ(v.samples, 2);
  EXPECT_THAT(v.sentence, testing::HasSubstr("0.350 m"));
}

TEST(FlightCheck, CatchesAJumpOverAThinWallBetweenTwoSamples) {
  const auto v = judge(tree_of(wall_at_x(10, 20)),
                       {at(0.0, Vec3(-20.0, 0.03, 0.02)), at(0.01, Vec3(22.0, 0.03, 0.02))});
  EXPECT_TRUE(v.touched);
  EXPECT_EQ(v.clearance_m, 0.0);
  EXPECT_NEAR(v.clearance_t_s, 0.01 * (1.0 - 0.15 + 20.0) / 42.0, 1e-6);
  EXPECT_NEAR(v.clearance_place_map.x(), 1.0, 0.02);
  EXPECT_THAT(v.sentence, testing::HasSubstr("touched an obstacle"));
}

TEST(FlightCheck, CatchesAnArmThatSweepsThroughAVoxelWhileTurning) {
  // A long box that turns on the spot: both its ends are clear before and after.
  const Body bar{.height_m = 0.05, .is_box = true, .length_m = 2.0, .width_m = 0.05};
  const auto track = [](double angle_rad) {
    return std::vector<Sample>{at(0.0, Vec3::Zero()),
                               at(1.0, Vec3::Zero(), turn(angle_rad, {0, 0, 1}))};
  };
  const std::vector<Index3> voxel{{6, 6, 0}};
  EXPECT_TRUE(judge(tree_of(voxel), track(M_PI_2), bar).touched);
  EXPECT_FALSE(judge(tree_of(voxel), track(-M_PI_2), bar).touched);
}

TEST(FlightCheck, PassesThroughAGapOnlyWhereTheBodyFits) {
  // Two walls, 0.4 m apart, and a flight between them.
  std::vector<Index3> voxels = wall_at_x(-3, 10);
  for (const Index3& i : wall_at_x(2, 10)) voxels.push_back(i);
  const std::vector<Sample> level{at(0.0, Vec3(0, -3, 0)), at(1.0, Vec3(0, 3, 0))};
  const auto fits = judge(tree_of(voxels), level, {.radius_m = 0.19, .height_m = 0.1});
  EXPECT_FALSE(fits.touched);
  EXPECT_NEAR(fits.clearance_m, 0.01, 1e-3);
  EXPECT_TRUE(judge(tree_of(voxels), level, {.radius_m = 0.201, .height_m = 0.1}).touched);
  // On its side the wide body fits as well.
  const auto q = turn(M_PI_2, {0, 1, 0});
  EXPECT_FALSE(judge(tree_of(voxels), {at(0.0, Vec3(0, -3, 0), q), at(1.0, Vec3(0, 3, 0), q)},
                     {.radius_m = 0.5, .height_m = 0.1})
                   .touched);
}

TEST(FlightCheck, TellsAHairsbreadthFromContact) {
  const auto along = [](double x) {
    return std::vector<Sample>{at(0.0, Vec3(x, -1, 0)), at(1.0, Vec3(x, 1, 0))};
  };
  const auto near = judge(tree_of(wall_at_x(0, 5)), along(-0.15 - 5e-4));
  EXPECT_FALSE(near.touched);
  EXPECT_NEAR(near.clearance_m, 5e-4, 3e-4);
  EXPECT_TRUE(judge(tree_of(wall_at_x(0, 5)), along(-0.15 + 5e-4)).touched);
}

TEST(FlightCheck, AgreesWithBruteForceOnRandomFlights) {
  Random random(11);
  const Body body{.radius_m = 0.15, .height_m = 0.1};
  int touched = 0;
  for (int flight = 0; flight < 60; ++flight) {
    std::vector<Index3> voxels;
    const int count = 3 + random.below(12);
    for (int i = 0; i < count; ++i) {
      voxels.push_back({random.below(24) - 12, random.below(24) - 12, random.below(10) - 5});
    }
    const Sample a = at(0.0, Vec3(-2.0, random.uniform(-1, 1), random.uniform(-0.4, 0.4)),
                        turn(random.uniform(-0.6, 0.6), {1, 1, 0}));
    const Sample b = at(2.0, Vec3(2.0, random.uniform(-1, 1), random.uniform(-0.4, 0.4)),
                        turn(random.uniform(-0.6, 0.6), {1, -1, 0.3}));
    double truth_m = std::numeric_limits<double>::infinity();
    double first_contact_s = std::numeric_limits<double>::infinity();
    constexpr int kSteps = 400;  // 1 cm
    for (int k = 0; k <= kSteps; ++k) {
      const double u = double(k) / kSteps;
      const Sample s = at(2.0 * u, a.position_map + u * (b.position_map - a.position_map),
                          a.q_map_base.slerp(u, b.q_map_base));
      const double d = brute_force(s, body, voxels).at_most_m;
      if (d < 1e-6 && std::isinf(first_contact_s)) first_contact_s = s.t_s;
      truth_m = std::min(truth_m, d);
      if (truth_m < 1e-6) break;
    }
    const Verdict v = judge(tree_of(voxels), {a, b}, body);
    touched += v.touched;
    if (truth_m < 1e-6) {
      EXPECT_TRUE(v.touched) << "flight " << flight;
      EXPECT_LE(v.clearance_t_s, first_contact_s + 1e-9);
      EXPECT_GE(v.clearance_t_s, first_contact_s - 0.1);
    } else if (!v.touched) {
      // The samples of the truth are 1 cm apart: it can only be too large, by half of that and
      // what the turn adds.
      EXPECT_LE(v.clearance_m, truth_m + 1e-3 + 2e-5) << "flight " << flight;
      EXPECT_GE(v.clearance_m, truth_m - 8e-3) << "flight " << flight;
    } else {
      EXPECT_LE(truth_m, 8e-3) << "flight " << flight;
    }
  }
  EXPECT_GT(touched, 5);
  EXPECT_LT(touched, 55);
}

TEST(FlightCheck, SaysTheSameTwiceAndForATrackCutIntoPieces) {
  const auto check = FlightCheck::from_tree(tree_of({{10, 0, 0}, {4, 9, 1}})).value();
  std::vector<Sample> coarse{at(0.0, Vec3(0, -2, 0)), at(4.0, Vec3(0, 2, 0))};
  std::vector<Sample> fine;
  for (int k = 0; k <= 400; ++k) fine.push_back(at(0.01 * k, Vec3(0, -2 + 0.01 * k, 0)));
  const Verdict once = check.judge(coarse).value();
  const Verdict again = check.judge(coarse).value();
  EXPECT_EQ(once.clearance_m, again.clearance_m);
  EXPECT_EQ(once.queries, again.queries);
  EXPECT_NEAR(check.judge(fine).value().clearance_m, once.clearance_m, 1e-3);
}

// A weaving flight of 10 s at 100 Hz through random voxels.
std::vector<Sample> weave(Random& random) {
  const double a = random.uniform(0.2, 0.6), b = random.uniform(0.1, 0.4);
  std::vector<Sample> track;
  for (int k = 0; k <= 1000; ++k) {
    const double t_s = 0.01 * k;
    track.push_back(at(t_s, Vec3(-2.0 + 0.4 * t_s, a * std::sin(t_s), b * std::cos(2.0 * t_s)),
                       turn(0.3 * std::sin(3.0 * t_s), {0, 1, 0.2})));
  }
  return track;
}

TEST(FlightCheck, MeasuresFewPosesOfALongFlightAndFindsWhatAllWouldShow) {
  Random random(13);
  int touched = 0;
  for (int flight = 0; flight < 30; ++flight) {
    std::vector<Index3> voxels;
    for (int i = 0; i < 4; ++i) {
      voxels.push_back({random.below(40) - 20, random.below(24) - 12, random.below(16) - 8});
    }
    const auto check = FlightCheck::from_tree(tree_of(voxels)).value();
    const auto track = weave(random);
    const Verdict verdict = check.judge(track).value();
    double smallest_m = std::numeric_limits<double>::infinity();
    std::int64_t measured = 0;
    for (const Sample& s : track) {
      const Verdict here = check.judge(std::span(&s, 1)).value();
      smallest_m = std::min(smallest_m, here.clearance_m);
      measured += here.queries;
      if (here.touched) break;
    }
    touched += verdict.touched;
    if (smallest_m == 0.0) {
      EXPECT_TRUE(verdict.touched) << flight;
    } else if (!verdict.touched) {
      EXPECT_NEAR(verdict.clearance_m, smallest_m, 1.1e-3) << flight;
      EXPECT_LT(verdict.queries, measured / 4) << flight;
    }
  }
  EXPECT_GT(touched, 3);
  EXPECT_LT(touched, 27);
}

TEST(FlightCheck, NeedsAHandfulOfMeasurementsIfOnlySmallerClearancesMatter) {
  const auto check = FlightCheck::from_tree(tree_of(wall_at_x(10, 20))).value();
  std::vector<Sample> along;  // 0.35 m from the wall, all the way
  for (int k = 0; k <= 400; ++k) along.push_back(at(0.01 * k, Vec3(0.5, -2 + 0.01 * k, 0)));
  EXPECT_LT(check.judge(along, 0.1).value().queries, 20);
  EXPECT_LT(check.judge(along, 0.0).value().queries, 20);
  EXPECT_FALSE(check.judge(along, 0.0).value().touched);
  along[300].position_map.x() = 1.0;
  EXPECT_TRUE(check.judge(along, 0.0).value().touched);
  along[300].position_map.x() = 0.8;
  EXPECT_NEAR(check.judge(along, 0.2).value().clearance_m, 0.05, 1e-3);
}

TEST(FlightCheck, FindsTheFirstContactOfSeveral) {
  std::vector<Index3> voxels = wall_at_x(0, 5);
  for (const Index3& i : wall_at_x(20, 5)) voxels.push_back(i);
  std::vector<Sample> through;
  for (int k = 0; k <= 600; ++k) through.push_back(at(0.01 * k, Vec3(-2 + 0.01 * k, 0.03, 0.03)));
  const Verdict v = judge(tree_of(voxels), through);
  EXPECT_TRUE(v.touched);
  EXPECT_NEAR(v.clearance_t_s, 2.0 - 0.15, 1e-3);
}

TEST(FlightCheck, TouchesFromTheFirstSampleOn) {
  const auto v =
      judge(tree_of({{0, 0, 0}}), {at(3.0, Vec3(0.05, 0.05, 0.05)), at(4.0, Vec3(5, 5, 5))});
  EXPECT_TRUE(v.touched);
  EXPECT_EQ(v.clearance_t_s, 3.0);
  EXPECT_LT((v.clearance_place_map - Vec3(0.05, 0.05, 0.05)).norm(), 0.3);
}

}  // namespace
}  // namespace goshawk::flight_check::test
