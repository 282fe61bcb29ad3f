#include <gmock/gmock.h>

#include <set>

#include "snapshots.hpp"

namespace goshawk::why {
namespace {

using Nav = Snapshot::Navigator::State;
using testing::HasSubstr;

/// The navigator gave its goal up.
Snapshot failed(ErrorCode code, const Vec3& goal_map, const std::string& message = "why") {
  Snapshot s = at_rest();
  s.navigator->state = Nav::failed;
  s.navigator->goal_map = goal_map;
  s.navigator->reason = {code, message};
  return s;
}

Snapshot with(Snapshot s, VoxelGrid grid) {
  s.map = std::make_shared<const VoxelGrid>(std::move(grid));
  return s;
}

TEST(Why, AVehicleThatHasArrivedIsBoundByNothing) {
  const Reason reason = explain(at_rest());
  EXPECT_EQ(reason.binds, Binds::nothing);
  EXPECT_EQ(reason.doing, "The vehicle hovers at (1.000, 1.000, 1.000).");
  EXPECT_EQ(reason.because, "It has arrived at its goal.");
  EXPECT_EQ(reason.mend, "");
}

TEST(Why, WhoIsNotHeardComesFirst) {
  Snapshot s = failed(ErrorCode::no_path, {5, 5, 1});
  s.tracker->age_s = 2.0;
  EXPECT_EQ(explain(s).binds, Binds::silent_stage);
  EXPECT_EQ(explain(s).stage, StageRole::tracker);
  s.vehicle->age_s = 3.0;
  EXPECT_EQ(explain(s).binds, Binds::no_odometry);
  EXPECT_EQ(explain(s).because, "No odometry has come for 3.0 s.");
  EXPECT_EQ(explain(s).doing, "The vehicle's position is unknown.");
  s.navigator->age_s = 4.0;
  EXPECT_EQ(explain(s).binds, Binds::no_navigator);
  EXPECT_EQ(explain(s).because, "The navigator has been silent for 4.0 s.");
  EXPECT_EQ(explain(Snapshot{}).because, "No navigator is heard.");
  s.navigator->age_s = 0.0;
  s.vehicle.reset();
  EXPECT_EQ(explain(s).because, "No odometry comes.");
}

TEST(Why, AnotherHandOnTheVehicleIsNamed) {
  using Control = Snapshot::Status::Control;
  Snapshot s = failed(ErrorCode::no_path, {5, 5, 1});
  s.status = Snapshot::Status{.control = Control::autopilot};
  EXPECT_EQ(explain(s).binds, Binds::other_control);
  EXPECT_THAT(explain(s).because, HasSubstr("failsafe"));
  s.status = Snapshot::Status{.failsafe = true};
  EXPECT_THAT(explain(s).because, HasSubstr("failsafe"));
  s.status = Snapshot::Status{.control = Control::pilot};
  EXPECT_THAT(explain(s).because, HasSubstr("remote control"));
  s.status = Snapshot::Status{.armed = false};
  EXPECT_EQ(explain(s).binds, Binds::disarmed);
}

TEST(Why, AHoldAndAMissionThatWaitsNameTheirCommand) {
  Snapshot s = at_rest();
  s.mission = Snapshot::Mission{.waits = true, .message = "waypoint 2 of 3: a wall"};
  EXPECT_EQ(explain(s).binds, Binds::mission_waits);
  EXPECT_THAT(explain(s).because, HasSubstr("waypoint 2 of 3: a wall"));
  EXPECT_THAT(explain(s).mend, HasSubstr("goshawk resume"));
  s.navigator->state = Nav::held;
  EXPECT_EQ(explain(s).binds, Binds::operator_hold);
  EXPECT_THAT(explain(s).mend, HasSubstr("goshawk resume"));
}

TEST(Why, WithoutAGoalOrAMapItSaysSo) {
  Snapshot s = at_rest();
  s.navigator->state = Nav::idle;
  EXPECT_EQ(explain(s).binds, Binds::no_goal);
  s.map = nullptr;
  EXPECT_EQ(explain(s).binds, Binds::no_map);
  EXPECT_EQ(explain(s).stage, StageRole::map_server);
}

TEST(Why, AGoalBesideAnObstacleNamesTheVoxelThatBlocksIt) {
  VoxelGrid grid = room();
  put_obstacle(grid, {25, 25, 5});  // [5, 5.2] x [5, 5.2] x [1, 1.2]
  put_obstacle(grid, {40, 40, 5});
  const Snapshot s = with(failed(ErrorCode::goal_occupied, {4.9, 5.1, 1.1}), grid);
  const Reason reason = explain(s);
  EXPECT_EQ(reason.binds, Binds::goal_blocked);
  ASSERT_TRUE(reason.voxel);
  EXPECT_EQ(reason.voxel->index, (Index3{25, 25, 5}));
  EXPECT_NEAR(reason.voxel->distance_m, 0.1, 1e-9);
  EXPECT_EQ(reason.because,
            "Its goal (4.900, 5.100, 1.100) is 0.10 m from the obstacle at (5.100, 5.100, 1.100) "
            "(voxel (25, 25, 5)) in map 7, 0.4 s old; the vehicle's centre keeps 0.20 m.");
  EXPECT_EQ(reason.parameter, "map_server margin_m");
}

TEST(Why, AGoalInSpaceThatWasNeverSeenNamesIt) {
  VoxelGrid grid = room();
  grid.known.set({25, 25, 5}, false);
  grid.grown.set({25, 25, 5}, true);
  const Reason reason = explain(with(failed(ErrorCode::goal_unknown, {5.1, 5.1, 1.1}), grid));
  EXPECT_EQ(reason.binds, Binds::goal_unknown);
  ASSERT_TRUE(reason.voxel);
  EXPECT_FALSE(reason.voxel->known);
  EXPECT_THAT(reason.because, HasSubstr("space never seen at (5.100, 5.100, 1.100)"));
  EXPECT_EQ(reason.parameter, "map_server unknown");
}

TEST(Why, AVehicleBesideAnObstacleNamesIt) {
  VoxelGrid grid = room();
  put_obstacle(grid, {6, 5, 5});  // from x = 1.2 m on
  Snapshot s = with(failed(ErrorCode::start_occupied, {5, 5, 1}), grid);
  s.vehicle->position_map = {1.1, 1.1, 1.1};
  const Reason reason = explain(s);
  EXPECT_EQ(reason.binds, Binds::start_blocked);
  EXPECT_EQ(reason.voxel->index, (Index3{6, 5, 5}));
}

TEST(Why, AGoalThatTheNewestMapShowsFreeMayBeSentAgain) {
  const Reason reason = explain(failed(ErrorCode::goal_occupied, {5, 5, 1}, "in an obstacle"));
  EXPECT_EQ(reason.binds, Binds::goal_blocked);
  EXPECT_FALSE(reason.voxel);
  EXPECT_THAT(reason.because, HasSubstr("was refused: in an obstacle"));
  EXPECT_THAT(reason.mend, HasSubstr("send the goal again"));
}

TEST(Why, AGoalOutsideTheMapAndOneThatIsCutOffAreToldApart) {
  const Reason outside = explain(failed(ErrorCode::goal_outside, {50, 5, 1}));
  EXPECT_EQ(outside.binds, Binds::goal_outside);
  EXPECT_THAT(outside.mend, HasSubstr("(10.000, 10.000, 4.000)"));
  const Reason kept_out = explain(failed(ErrorCode::goal_outside, {5, 5, 1}, "cut by search_box"));
  EXPECT_EQ(kept_out.binds, Binds::refused) << "the map reaches there";
  EXPECT_THAT(kept_out.because, HasSubstr("cut by search_box"));
  const Reason cut_off = explain(failed(ErrorCode::no_path, {5, 5, 1}));
  EXPECT_EQ(cut_off.binds, Binds::unreachable);
  EXPECT_THAT(cut_off.because, HasSubstr("(5.000, 5.000, 1.000) in map 7"));
}

TEST(Why, AStageThatDoesNotAnswerIsNamedByWhoHasAnswered) {
  Snapshot s = at_rest();
  s.navigator->state = Nav::planning;
  s.navigator->since_s = 0.8;
  const auto answers = [&](StageRole stage, std::uint64_t id) {
    s.reports.push_back({.stage = stage, .request_id = id});
  };
  answers(StageRole::path_search, 4);  // the request before
  EXPECT_EQ(explain(s).stage, StageRole::path_search);
  answers(StageRole::path_search, 5);
  EXPECT_EQ(explain(s).stage, StageRole::corridor_builder);
  answers(StageRole::corridor_builder, 5);
  const Reason reason = explain(s);
  EXPECT_EQ(reason.binds, Binds::silent_stage);
  EXPECT_EQ(reason.stage, StageRole::trajectory_optimizer);
  EXPECT_EQ(reason.because, "trajectory_optimizer has not answered request 5 for 0.8 s.");
  EXPECT_EQ(reason.parameter, "navigator plan_timeout_s");
  s.navigator->state = Nav::failed;
  s.navigator->reason = {ErrorCode::stage_silent, "it was silent"};
  EXPECT_EQ(explain(s).stage, StageRole::trajectory_optimizer);
}

TEST(Why, APlanThatWasOnlyJustAskedForIsNobodysFault) {
  Snapshot s = at_rest();
  s.navigator->state = Nav::planning;
  s.navigator->since_s = 0.1;
  EXPECT_EQ(explain(s).binds, Binds::nothing);
  EXPECT_EQ(explain(s).because, "It asked for a plan 0.1 s ago.");
}

TEST(Why, AnyOtherRefusalIsToldWithItsStageAndSentence) {
  Snapshot s = failed(ErrorCode::invalid_limits, {5, 5, 1}, "v_max is 0");
  s.reports.push_back({.stage = StageRole::path_search, .request_id = 5});
  s.reports.push_back({.stage = StageRole::trajectory_optimizer,
                       .request_id = 5,
                       .outcome = {ErrorCode::invalid_limits, "v_max is 0"}});
  const Reason reason = explain(s);
  EXPECT_EQ(reason.binds, Binds::refused);
  EXPECT_EQ(reason.stage, StageRole::trajectory_optimizer);
  EXPECT_EQ(reason.because, "invalid_limits: v_max is 0.");
}

TEST(Why, ATrackerThatStopsByItselfSaysWhy) {
  Snapshot s = failed(ErrorCode::no_path, {5, 5, 1});
  s.tracker->mode = Snapshot::Tracker::Mode::brake;
  EXPECT_EQ(explain(s).because, "The tracker brakes it.");
  s.reports.push_back({.stage = StageRole::tracker,
                       .outcome = {ErrorCode::tracking_lost, "0.3 m from its reference"}});
  EXPECT_EQ(explain(s).binds, Binds::tracker_stops);
  EXPECT_EQ(explain(s).because, "The tracker brakes it: 0.3 m from its reference.");
  s.tracker->mode = Snapshot::Tracker::Mode::land;
  EXPECT_THAT(explain(s).because, HasSubstr("lands it: "));
}

TEST(Why, EveryCauseHasAWordOfItsOwn) {
  std::set<std::string_view> words;
  for (int k = 0; k <= int(Binds::way); ++k) words.insert(to_string(Binds(k)));
  EXPECT_EQ(words.size(), std::size_t(Binds::way) + 1);
}

}  // namespace
}  // namespace goshawk::why
