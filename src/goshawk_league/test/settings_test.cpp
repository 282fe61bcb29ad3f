#include "goshawk/league/settings.hpp"

#include <gtest/gtest.h>

#include <fstream>

namespace goshawk::league {
namespace {

TEST(Settings, ReachEachStage) {
  closed_loop::Setup setup;
  for (const char* setting :
       {"tracker:max_tilt_rad=1.0", "navigator:max_attempts=7", "navigator:fly_unknown=true",
        "navigator:unknown=costly", "simulator:mass_kg=1.5", "path_search:reuse_path=true",
        "corridor_builder:local_box_m=3", "trajectory_optimizer:min_pieces=4"}) {
    EXPECT_TRUE(apply_setting(setting, setup)) << setting;
  }
  EXPECT_EQ(setup.tracker.max_tilt_rad, 1.0);
  EXPECT_EQ(setup.navigator.max_attempts, 7);
  EXPECT_TRUE(setup.navigator.fly_unknown);
  EXPECT_EQ(setup.navigator.unknown, UnknownSpace::costly);
  EXPECT_EQ(setup.vehicle.vehicle.mass_kg, 1.5);
  EXPECT_TRUE(setup.planning.search.reuse_path);
  EXPECT_EQ(setup.planning.corridor.local_box_m, 3.0);
  EXPECT_EQ(setup.planning.optimizer.min_pieces, 4);
}

TEST(Settings, WhatIsWrongIsNamed) {
  closed_loop::Setup setup;
  const auto said = [&](const char* setting) {
    const auto status = apply_setting(setting, setup);
    EXPECT_EQ(status.code(), ErrorCode::invalid_parameter);
    return status ? std::string() : status.error().message;
  };
  EXPECT_NE(said("tracker").find("NODE:PARAMETER=VALUE"), std::string::npos);
  EXPECT_NE(said("pilot:x=1").find("'pilot'"), std::string::npos);
  EXPECT_NE(said("tracker:speed=1").find("no such parameter"), std::string::npos);
  EXPECT_NE(said("tracker:max_tilt_rad=steep").find("not of its type"), std::string::npos);
  EXPECT_NE(said("tracker:max_tilt_rad=1.0x").find("not of its type"), std::string::npos);
  EXPECT_NE(said("navigator:unknown=maybe").find("not of its type"), std::string::npos);
}

TEST(Settings, TheRacersFileIsOneThatTheStagesTake) {
  closed_loop::Setup setup;
  ASSERT_TRUE(apply_file(RACER, setup));
  EXPECT_EQ(setup.vehicle.vehicle.max_motor_thrust_n, 14.0);
  EXPECT_GT(setup.tracker.max_thrust_n, 45.0);
  EXPECT_TRUE(closed_loop::make_vehicle(closed_loop::Tracking::physical, setup.vehicle, {0, 0, 1}));
  EXPECT_TRUE(tracker::Tracker::create(setup.tracker));
  EXPECT_TRUE(closed_loop::Planning::create(setup.planning));
}

TEST(Settings, AFileThatIsNoneIsNamed) {
  closed_loop::Setup setup;
  const auto missing = apply_file("/nowhere/racer.yaml", setup);
  EXPECT_EQ(missing.code(), ErrorCode::io_failed);
  const auto file = std::filesystem::temp_directory_path() / "goshawk_league_settings_test.yaml";
  std::ofstream(file) << "tracker:\n  ros__parameters:\n    speed: 1.0\n";
  const auto wrong = apply_file(file, setup);
  EXPECT_EQ(wrong.code(), ErrorCode::invalid_parameter);
  EXPECT_NE(wrong.error().message.find(file.string()), std::string::npos);
  std::filesystem::remove(file);
}

}  // namespace
}  // namespace goshawk::league
