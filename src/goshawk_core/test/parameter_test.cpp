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

TEST(ParameterFaults, NamesEveryValueThatIsNotAllowedAndNoOther) {
  ParameterFaults faults;
  faults("mass_kg", -1.0, "kg", "", Range::positive(10.0));
  faults("count", 3, "", "", Range{1, 5});
  faults("flag", true, "", "", Anything{});
  faults("offset_m", NAN, "m", "", Anything{});
  faults("free", std::string("any"), "", "", Anything{});
  faults("kind", std::string("cubic"), "", "", OneOf{{"round", "square"}});
  faults.add("a is above b");
  const auto status = faults.status("no: ");
  ASSERT_FALSE(status);
  EXPECT_EQ(status.code(), ErrorCode::invalid_parameter);
  EXPECT_EQ(status.error().message,
            "no: mass_kg is -1 kg and must be in (0, 10]; offset_m is not finite; kind is 'cubic' "
            "and must be one of round square; a is above b");
}

TEST(ParameterFaults, NoFaultIsSuccess) {
  ParameterFaults faults;
  faults("x", 0.5, "m", "", Range{0.0, 1.0});
  faults("kind", std::string("round"), "", "", OneOf{{"round"}});
  EXPECT_TRUE(faults.empty());
  EXPECT_TRUE(faults.status());
}

}  // namespace
}  // namespace goshawk
