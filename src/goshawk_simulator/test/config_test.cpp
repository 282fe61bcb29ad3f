#include "goshawk/simulator/config.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <set>
#include <string>

#include "goshawk/simulator/quadrotor.hpp"

namespace goshawk::simulator {
namespace {

using testing::HasSubstr;

TEST(Config, DefaultsAreValid) {
  EXPECT_TRUE(check(Config{}));
}

TEST(Config, NamesAreUniqueAndValuesCanBeWritten) {
  Config config;
  std::set<std::string> names;
  describe(config, [&](const char* name, auto& value, const char*, const char* text, const auto&) {
    EXPECT_TRUE(names.insert(name).second) << name;
    EXPECT_FALSE(std::string(text).empty()) << name;
    if constexpr (std::is_arithmetic_v<std::remove_reference_t<decltype(value)>>) value = 3;
  });
  EXPECT_EQ(config.vehicle.mass_kg, 3.0);
  EXPECT_EQ(config.gust_seed, 3);
}

TEST(Config, EveryFaultStopsTheCreationWithOneSentence) {
  Config config;
  config.command_timeout_s = std::nan("");
  config.wind_x_m_s = 1000.0;
  config.gust_seed = -1;
  config.vehicle.inertia_zz_kg_m2 = 0.1;
  const auto quadrotor = Quadrotor::create(config);
  ASSERT_FALSE(quadrotor);
  EXPECT_EQ(quadrotor.code(), ErrorCode::invalid_parameter);
  for (const char* name : {"command_timeout_s", "wind_x_m_s", "gust_seed", "triangle"}) {
    EXPECT_THAT(quadrotor.error().message, HasSubstr(name));
  }
}

}  // namespace
}  // namespace goshawk::simulator
