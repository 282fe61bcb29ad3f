#include "goshawk/core/parameter.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace goshawk {
namespace {

TEST(Range, ContainsItsEndsUnlessTheLowerIsExcluded) {
  EXPECT_TRUE((Range{0.0, 1.0}.contains(0.0)));
  EXPECT_TRUE((Range{0.0, 1.0}.contains(1.0)));
  EXPECT_FALSE((Range{0.0, 1.0, true}.contains(0.0)));
  EXPECT_TRUE((Range{0.0, 1.0, true}.contains(1e-300)));
  EXPECT_FALSE((Range{0.0, 1.0}.contains(std::nextafter(1.0, 2.0))));
  EXPECT_FALSE((Range{0.0, 1.0}.contains(-1e-300)));
}

TEST(Range, NeverContainsNaN) {
  EXPECT_FALSE(Range{}.contains(NAN));
  EXPECT_FALSE((Range{0.0, 1.0}.contains(NAN)));
  EXPECT_FALSE(Range::positive().contains(NAN));
}

TEST(Range, PositiveIsFiniteAndAboveZero) {
  EXPECT_TRUE(Range::positive().contains(1e-300));
  EXPECT_TRUE(Range::positive().contains(1e300));
  EXPECT_FALSE(Range::positive().contains(0.0));
  EXPECT_FALSE(Range::positive().contains(-1.0));
  EXPECT_FALSE(Range::positive().contains(HUGE_VAL));
  EXPECT_FALSE(Range::positive(10.0).contains(10.5));
}

}  // namespace
}  // namespace goshawk
