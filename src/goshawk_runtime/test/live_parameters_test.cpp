#include "goshawk/runtime/live_parameters.hpp"

#include <gmock/gmock.h>

#include "test_config.hpp"

namespace goshawk::runtime {
namespace {

using runtime_test::Config;
using runtime_test::Planner;
using testing::AllOf;
using testing::HasSubstr;

ParameterSource wanted(std::initializer_list<std::pair<const char*, const char*>> values) {
  ParameterSource source;
  for (const auto& [name, value] : values) {
    source.set(name, ParameterSource::written(value, "asked by a test"));
  }
  return source;
}

/// A component that counts what it took on, and can refuse.
class Live : public testing::Test {
 protected:
  std::string refused(const ParameterSource& source) {
    const int before = taken_;
    const auto answer = live_.set(source);
    EXPECT_FALSE(answer);
    EXPECT_EQ(taken_, before) << "the component saw what was refused";
    EXPECT_EQ(answer.code(), ErrorCode::invalid_parameter);
    return answer ? "" : answer.error().message;
  }
  std::string value_of(const std::string& name) {
    for (const auto& p : live_.list()) {
      if (p.name == name) return p.value;
    }
    return "none";
  }

  Config config_;
  int taken_ = 0;
  LiveConfig<Config> live_{config_, "search", [this](const Config& c) -> Status {
                             if (c.speed_m_s > 50.0) {
                               return fail(ErrorCode::invalid_parameter, "too fast for count");
                             }
                             config_ = c;
                             ++taken_;
                             return success();
                           }};
};

TEST_F(Live, TakesSeveralAtOnceAndTellsOldAndNew) {
  const auto changes = live_.set(wanted({{"label", "'12'"}, {"speed_m_s", "3"}}));
  ASSERT_TRUE(changes) << changes.error().message;
  ASSERT_EQ(changes->size(), 2U);
  EXPECT_EQ((*changes)[0].name, "speed_m_s");
  EXPECT_EQ((*changes)[0].old_value, "2");
  EXPECT_EQ((*changes)[0].value, "3");
  EXPECT_EQ((*changes)[1].value, "12");
  EXPECT_EQ(taken_, 1);
  EXPECT_EQ(config_.speed_m_s, 3.0);
  EXPECT_EQ(config_.label, "12");
  EXPECT_EQ(value_of("speed_m_s"), "3");
  EXPECT_EQ((*live_.set(wanted({{"speed_m_s", "4"}})))[0].old_value, "3");
}

TEST_F(Live, OneFaultAndNothingChanges) {
  const std::string fault =
      refused(wanted({{"speed_m_s", "3"}, {"label", "x"}, {"enabled", "maybe"}}));
  EXPECT_THAT(fault, AllOf(HasSubstr("enabled: 'maybe' is not true or false"),
                           HasSubstr("asked by a test")));
  EXPECT_EQ(config_.speed_m_s, 2.0);
  EXPECT_EQ(value_of("speed_m_s"), "2");
  EXPECT_EQ(value_of("label"), "");
}

TEST_F(Live, EachKindOfFaultIsASentence) {
  EXPECT_THAT(refused(wanted({{"speed_m_s", "-1"}})), HasSubstr("must be above 0"));
  EXPECT_THAT(refused(wanted({{"speed_m_s", "nan"}})), HasSubstr("out of range"));
  EXPECT_THAT(refused(wanted({{"speed_m_s", "fast"}})), HasSubstr("is not a number"));
  EXPECT_THAT(refused(wanted({{"speed", "1"}})), HasSubstr("did you mean speed_m_s?"));
  EXPECT_THAT(refused(wanted({{"radius_m", "1"}})),
              HasSubstr("takes effect at start only: restart the node with -p radius_m:=1"));
  EXPECT_THAT(refused(wanted({{"use_sim_time", "true"}})), HasSubstr("at start only"));
  EXPECT_THAT(refused(wanted({{"radius_m", "1"}, {"speed_m_s", "0"}})),
              HasSubstr("2 parameter faults"));
}

TEST_F(Live, WhatTheComponentRefusesDoesNotHold) {
  const auto answer = live_.set(wanted({{"speed_m_s", "60"}}));
  ASSERT_FALSE(answer);
  EXPECT_EQ(answer.error().message, "too fast for count");
  EXPECT_EQ(value_of("speed_m_s"), "2");
}

TEST(LiveConfig, OfAComponentThatTakesNothingOnNothingChanges) {
  LiveConfig<Config> live(Config{}, "search", {});
  for (const auto& p : live.list()) EXPECT_FALSE(p.at_run_time) << p.name;
  EXPECT_THAT(live.set(wanted({{"speed_m_s", "3"}})).error().message, HasSubstr("at start only"));
}

TEST(CheckChange, NamesWhatHoldsFromStartToEnd) {
  Config to;
  EXPECT_TRUE(check_change(Config{}, to));
  to.speed_m_s = 3.0;
  EXPECT_TRUE(check_change(Config{}, to));
  to.radius_m = 1.0;
  to.planner = Planner::astar;
  EXPECT_THAT(check_change(Config{}, to).error().message, HasSubstr("radius_m, planner cannot"));
}

}  // namespace
}  // namespace goshawk::runtime
