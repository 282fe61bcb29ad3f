#include "goshawk/map_server/config.hpp"

#include <gmock/gmock.h>

#include <set>

namespace goshawk::map_server {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

// Checks a value against its rule, as the parameter reader does.
struct Checker {
  std::set<std::string> names;
  bool all_valid = true;

  template <typename T>
  void operator()(const char* name, const T& value, const char*, const char*, const Range& rule) {
    names.insert(name);
    all_valid &= rule.contains(double(value));
  }
  template <typename T>
  void operator()(const char* name, const T&, const char*, const char*, const Anything&) {
    names.insert(name);
  }
};

TEST(Config, DefaultsAreValidAndEveryParameterIsDescribed) {
  const Config config;
  Checker checker;
  describe(config, checker);
  EXPECT_TRUE(checker.all_valid);
  EXPECT_EQ(checker.names.size(), 40U);
}

TEST(Config, InflationIsRadiusPlusMarginAndTheBoxIsOnlyUsedOnDemand) {
  Config config;
  EXPECT_DOUBLE_EQ(growth(config).inflation_m, 0.2);
  EXPECT_DOUBLE_EQ(growth(config).reserve_m, 0.0);
  config.reserve_m = 0.1;
  EXPECT_DOUBLE_EQ(growth(config).inflation_m, 0.2);
  EXPECT_DOUBLE_EQ(growth(config).reserve_m, 0.1);
  EXPECT_FALSE(voxelize_options(config).box);
  config.use_box = true;
  config.box_z_min_m = -1.0;
  ASSERT_TRUE(voxelize_options(config).box);
  EXPECT_EQ(voxelize_options(config).box->lower_map, Vec3(0, 0, -1));
  EXPECT_EQ(load_options(config).box->upper_map, Vec3(10, 10, 4));
}

TEST(Config, AFullMemoryForBricksIsToldWithWhatToDo) {
  Config config;
  config.max_kept_mb = 7;
  EXPECT_EQ(forgotten_fault(config).code, ErrorCode::map_too_large);
  EXPECT_THAT(forgotten_fault(config).message,
              AllOf(HasSubstr("max_kept_mb (7 MB)"), HasSubstr("Raise max_kept_mb"),
                    Not(HasSubstr("for free"))));
  config.unknown = UnknownPolicy::free;
  EXPECT_THAT(forgotten_fault(config).message, HasSubstr("this map takes for free"));
}

}  // namespace
}  // namespace goshawk::map_server
