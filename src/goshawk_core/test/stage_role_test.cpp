#include "goshawk/core/stage_role.hpp"

#include <gtest/gtest.h>

namespace goshawk {
namespace {

TEST(StageRole, HasAWordThatLeadsBackToIt) {
  for (int k = 0; k <= int(StageRole::obstacle_tracker); ++k) {
    EXPECT_EQ(stage_role_of(to_string(StageRole(k))), StageRole(k));
  }
  EXPECT_EQ(to_string(StageRole::path_search), "path_search");
}

TEST(StageRole, IsNoneForAnotherWord) {
  EXPECT_FALSE(stage_role_of("my_search"));
  EXPECT_FALSE(stage_role_of(""));
}

}  // namespace
}  // namespace goshawk
