#include "goshawk/map_server/sensor_watch.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace goshawk::map_server {
namespace {

using ::testing::HasSubstr;

constexpr std::int64_t kTenth_ns = 100'000'000;

// 10 scans a second of one sensor for so many seconds. @return what was told
std::vector<SensorWatch::News> run(SensorWatch& watch, std::int64_t& now_ns, double seconds,
                                   std::size_t returns, std::size_t far_returns) {
  std::vector<SensorWatch::News> told;
  for (int k = 0; k < int(10.0 * seconds); ++k) {
    watch.saw("lidar", returns, far_returns, now_ns);
    for (auto& news : watch.news(now_ns)) told.push_back(std::move(news));
    now_ns += kTenth_ns;
  }
  return told;
}

TEST(SensorWatch, SaysNothingOfASensorThatSees) {
  SensorWatch watch(1.0);
  std::int64_t now_ns = 5;
  EXPECT_TRUE(watch.news(now_ns).empty());  // none has come yet: there may be none
  EXPECT_TRUE(run(watch, now_ns, 20.0, 1000, 900).empty());
}

TEST(SensorWatch, TellsOnceOfOneThatStopsAndOnceThatItIsBack) {
  SensorWatch watch(1.0);
  std::int64_t now_ns = 0;
  run(watch, now_ns, 1.0, 1000, 900);
  std::vector<SensorWatch::News> told;
  for (int k = 0; k < 50; ++k, now_ns += kTenth_ns) {
    for (auto& news : watch.news(now_ns)) told.push_back(std::move(news));
  }
  ASSERT_EQ(told.size(), 1U);
  ASSERT_TRUE(told.front().fault);
  EXPECT_EQ(told.front().fault->code, ErrorCode::stage_silent);
  EXPECT_THAT(told.front().message, HasSubstr("no scan of sensor 'lidar'"));
  told = run(watch, now_ns, 1.0, 1000, 900);
  ASSERT_EQ(told.size(), 1U);
  EXPECT_FALSE(told.front().fault);
  EXPECT_THAT(told.front().message, HasSubstr("sees again"));
}

TEST(SensorWatch, TellsOfALensThatIsCovered) {
  for (const std::size_t returns : {std::size_t{0}, std::size_t{1000}}) {  // all missing, all near
    SensorWatch watch(1.0);
    std::int64_t now_ns = 0;
    run(watch, now_ns, 1.0, 1000, 900);
    const auto told = run(watch, now_ns, 5.0, returns, returns / 200);
    ASSERT_EQ(told.size(), 1U);
    ASSERT_TRUE(told.front().fault);
    EXPECT_THAT(told.front().message, HasSubstr(returns == 0 ? "no returns" : "nearer than 0.3 m"));
  }
}

TEST(SensorWatch, KeepsTwoSensorsApart) {
  SensorWatch watch(1.0);
  std::int64_t now_ns = 0;
  watch.saw("camera", 100, 100, now_ns);
  const auto told = run(watch, now_ns, 3.0, 1000, 900);
  ASSERT_EQ(told.size(), 1U);
  EXPECT_THAT(told.front().message, HasSubstr("'camera'"));
}

TEST(SensorWatch, OfNoTimeTellsNothing) {
  SensorWatch watch(0.0);
  std::int64_t now_ns = 0;
  run(watch, now_ns, 1.0, 0, 0);
  now_ns += 1'000 * kTenth_ns;
  EXPECT_TRUE(watch.news(now_ns).empty());
}

TEST(SensorWatch, HoldsNoMoreSensorsThanItsLimit) {
  SensorWatch watch(1.0);
  for (int k = 0; k < 100; ++k) watch.saw("sensor" + std::to_string(k), 1, 1, 0);
  EXPECT_EQ(watch.news(100 * kTenth_ns).size(), SensorWatch::kMostSensors);
}

}  // namespace
}  // namespace goshawk::map_server
