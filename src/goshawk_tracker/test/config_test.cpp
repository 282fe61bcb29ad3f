#include "goshawk/tracker/config.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <set>

#include "goshawk/tracker/tracker.hpp"

namespace goshawk::tracker {
namespace {

TEST(Config, DefaultsAreValid) {
  EXPECT_TRUE(check(Config{}));
}

TEST(Config, NamesAreUniqueAndEveryParameterIsExplained) {
  std::set<std::string> names;
  Config config;
  describe(config, [&](const char* name, auto&, const char*, const char* text, const auto&) {
    EXPECT_TRUE(names.insert(name).second) << name;
    EXPECT_FALSE(std::string(text).empty()) << name;
  });
}

TEST(Config, EveryFaultStopsTheCreationWithOneSentence) {
  Config config;
  config.controller = "lqr";
  config.mass_kg = 3.0;  // 29.4 N: more than max_thrust_n
  config.position_xy_1_s2 = -1.0;
  config.odometry_timeout_s = std::nan("");
  const auto tracker = Tracker::create(config);
  ASSERT_FALSE(tracker);
  EXPECT_EQ(tracker.code(), ErrorCode::invalid_parameter);
  for (const char* part :
       {"'lqr'", "geometric", "does not lift", "position_xy_1_s2", "odometry_timeout_s"}) {
    EXPECT_THAT(tracker.error().message, testing::HasSubstr(part));
  }
}

TEST(Config, LeastThrustAboveTheWeightIsRefused) {
  Config config;
  config.min_thrust_n = 12.0;
  EXPECT_THAT(check(config).error().message, testing::HasSubstr("min_thrust_n (12)"));
}

TEST(Config, WhatTheForceDependsOnDoesNotChangeInFlight) {
  Config config;
  auto tracker = Tracker::create(config).value();
  config.yaw = "keep";
  config.land_after_s = 30.0;
  EXPECT_TRUE(tracker.reconfigure(config));
  for (double Config::*field : {&Config::mass_kg, &Config::position_xy_1_s2, &Config::max_tilt_rad,
                                &Config::error_allowance_m, &Config::start_tolerance_m}) {
    Config other = config;
    other.*field *= 1.1;
    const auto status = tracker.reconfigure(other);
    ASSERT_FALSE(status);
    EXPECT_THAT(status.error().message, testing::HasSubstr("cannot change at run time"));
  }
  config.land_after_s = -1.0;
  EXPECT_THAT(tracker.reconfigure(config).error().message, testing::HasSubstr("land_after_s"));
}

}  // namespace
}  // namespace goshawk::tracker
