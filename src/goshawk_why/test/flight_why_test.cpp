#include <gmock/gmock.h>

#include "snapshots.hpp"

namespace goshawk::why {
namespace {

using testing::HasSubstr;

/// From rest to rest in one quintic: fastest in the middle, at 1.875 times its mean speed. Cut into
/// short pieces, so that its control points are hardly faster than the curve.
CertifiedTrajectory line(const Vec3& from, const Vec3& to, double duration_s, Limits limits) {
  constexpr int kPieces = 64;
  const auto whole = BezierPiece::between({.position = from}, {.position = to}, duration_s);
  Trajectory t;
  for (int k = 0; k < kPieces; ++k) {
    const auto at = [&](int n) { return whole.sample(duration_s * n / kPieces); };
    t.pieces.push_back(BezierPiece::between(at(k), at(k + 1), duration_s / kPieces));
  }
  return certify(std::move(t), {Polytope::box(Vec3::Constant(-50), Vec3::Constant(50))}, limits,
                 {.position = from}, {.position = to})
      .value();
}

Snapshot flies(CertifiedTrajectory nominal, double time_s, std::optional<StopPart> stop = {}) {
  Snapshot s = at_rest();
  s.navigator->state = Snapshot::Navigator::State::flying;
  s.tracker->mode = Snapshot::Tracker::Mode::follow;
  auto committed = CommittedTrajectory::make(
      {.id = 5, .nominal = std::move(nominal), .stop = std::move(stop), .map_version = 7});
  s.flown = Snapshot::Flown{std::move(committed).value(), time_s};
  s.vehicle->speed_m_s = 1.0;
  return s;
}

constexpr double kLength_m = 8.0;
const Vec3 kFrom{1, 1, 1}, kTo{1 + kLength_m, 1, 1};

/// With limits that are this many times what the quintic needs.
Snapshot flies_with(double speed_room, double acceleration_room, double time_s, double j_max = 0) {
  const double duration_s = 8.0;
  const double top_m_s = 1.875 * kLength_m / duration_s;
  const double top_m_s2 = 5.7735 * kLength_m / (duration_s * duration_s);
  CertifiedTrajectory wide = line(kFrom, kTo, duration_s,
                                  {.v_max_m_s = top_m_s * speed_room,
                                   .a_max_m_s2 = top_m_s2 * acceleration_room,
                                   .j_max_m_s3 = j_max});
  return flies(std::move(wide), time_s);
}

TEST(WhyInFlight, TheSpeedLimitBindsWhereItIsReached) {
  const Reason reason = explain(flies_with(1.01, 3.0, 4.0));
  EXPECT_EQ(reason.binds, Binds::speed_limit);
  EXPECT_EQ(reason.parameter, "navigator v_max_m_s");
  EXPECT_THAT(reason.because, HasSubstr("its limit of 1.89"));
}

TEST(WhyInFlight, TheAccelerationLimitBindsWhileItGainsSpeed) {
  // The quintic's acceleration is largest at 0.2113 of its time.
  const Snapshot s = flies_with(3.0, 1.02, 8.0 * 0.2113);
  const Reason reason = explain(s);
  EXPECT_EQ(reason.binds, Binds::acceleration_limit) << reason.because;
  EXPECT_EQ(reason.parameter, "navigator a_max_m_s2");
}

TEST(WhyInFlight, TowardsItsEndItSaysHowFarThatIs) {
  const Snapshot s = flies_with(3.0, 3.0, 6.0);
  const Reason reason = explain(s);
  EXPECT_EQ(reason.binds, Binds::end_ahead);
  const double left_m = kTo.x() - s.flown->committed.flown().sample(6.0).position.x();
  EXPECT_THAT(reason.because, HasSubstr(std::to_string(left_m).substr(0, 3)));
}

TEST(WhyInFlight, TheJerkLimitBindsAtTheStart) {
  const double jerk_m_s3 = 60.0 * kLength_m / (8.0 * 8.0 * 8.0);  // of the quintic at its ends
  const Reason reason = explain(flies_with(3.0, 3.0, 0.01, jerk_m_s3 * 1.03));
  EXPECT_EQ(reason.binds, Binds::jerk_limit) << reason.because;
}

TEST(WhyInFlight, BelowItsLimitsItGainsSpeed) {
  EXPECT_EQ(explain(flies_with(3.0, 3.0, 1.0)).because, "It gains speed.");
  EXPECT_EQ(explain(flies_with(3.0, 3.0, -0.25)).because, "It begins to fly in 0.25 s.");
  Snapshot s = flies_with(3.0, 3.0, 1.0);
  s.flown.reset();
  EXPECT_EQ(explain(s).because, "It waits for its first trajectory.");
}

TEST(WhyInFlight, SlowBelowAllLimitsItIsTheWay) {
  // Out and back on a bent line: slower before the bend, then faster again.
  const FlatState a{.position = {1, 1, 1}}, c{.position = {4, 4, 1}};
  const FlatState b{.position = {4, 1, 1}, .velocity = {0.2, 0.2, 0}};
  Trajectory bent{{BezierPiece::between(a, b, 4.0), BezierPiece::between(b, c, 4.0)}};
  const Limits limits{.v_max_m_s = 50.0, .a_max_m_s2 = 50.0};
  const auto certified = certify(
      std::move(bent), {Polytope::box(Vec3::Constant(-50), Vec3::Constant(50))}, limits, a, c);
  ASSERT_TRUE(certified) << certified.error().message;
  EXPECT_EQ(explain(flies(*certified, 3.0)).binds, Binds::way);
}

TEST(WhyInFlight, OnItsStopPartItNamesTheSpaceThatWasNotSeen) {
  const Limits limits{.v_max_m_s = 20.0, .a_max_m_s2 = 50.0};
  CertifiedTrajectory nominal = line(kFrom, kTo, 8.0, limits);
  const FlatState leaves = nominal.trajectory().sample(2.0);
  const Vec3 rest = leaves.position + Vec3(0.5, 0, 0);
  Trajectory way{{BezierPiece::between(leaves, {.position = rest}, 1.5)}};
  auto stop = certify(std::move(way), {Polytope::box(Vec3::Constant(-50), Vec3::Constant(50))},
                      limits, leaves, {.position = rest});
  ASSERT_TRUE(stop) << stop.error().message;
  Snapshot s = flies(std::move(nominal), 2.5, StopPart{2.0, *std::move(stop)});
  VoxelGrid grid = room();
  grid.unknown_is_occupied = false;
  for (int y = 0; y < 50; ++y) {
    for (int z = 0; z < 20; ++z) grid.known.set({20, y, z}, false);  // from x = 4 m on
  }
  s.map = std::make_shared<const VoxelGrid>(std::move(grid));
  const Reason reason = explain(s);
  EXPECT_EQ(reason.binds, Binds::unseen_ahead);
  ASSERT_TRUE(reason.voxel) << reason.because;
  EXPECT_NEAR(reason.voxel->center_map.x(), 4.1, 0.31);  // within the body's reach
  EXPECT_EQ(reason.parameter, "navigator fly_unknown");
}

}  // namespace
}  // namespace goshawk::why
