#include "goshawk/core/parameter.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <concepts>

namespace goshawk {
namespace {

enum class Shape { round, square };

constexpr auto words_of(Shape) {
  return std::to_array<Named<Shape>>({{Shape::round, "round"}, {Shape::square, "square"}});
}

struct Choice {
  Shape shape = Shape::round;
};

template <typename Self, typename Visitor>
requires std::same_as<std::remove_const_t<Self>, Choice>
void describe(Self& c, Visitor&& visit) {
  visit("shape", c.shape, "", "of all", Anything{});
}

TEST(Words, NameEachValueAndNothingElse) {
  static_assert(Worded<Shape> && !Worded<int> && !Worded<ErrorCode>);
  static_assert(to_word(Shape::square) == "square" && from_word<Shape>("round") == Shape::round);
  EXPECT_EQ(from_word<Shape>("Round"), std::nullopt);
  EXPECT_EQ(from_word<Shape>(""), std::nullopt);
  EXPECT_EQ(to_word(Shape(7)), "");
  EXPECT_EQ(all_words<Shape>(), (std::vector<std::string>{"round", "square"}));
}

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
  faults("shape", Shape(7), "", "", Anything{});
  faults("shape", Shape::square, "", "", Anything{});
  faults.add("a is above b");
  const auto status = faults.status("no: ");
  ASSERT_FALSE(status);
  EXPECT_EQ(status.code(), ErrorCode::invalid_parameter);
  EXPECT_EQ(status.error().message,
            "no: mass_kg is -1 kg and must be in (0, 10]; offset_m is not finite; kind is 'cubic' "
            "and must be one of round, square; shape is 7 and must be one of round, square; a is "
            "above b");
}

TEST(ParameterFaults, NoFaultIsSuccess) {
  ParameterFaults faults;
  faults("x", 0.5, "m", "", Range{0.0, 1.0});
  faults("kind", std::string("round"), "", "", OneOf{{"round"}});
  EXPECT_TRUE(faults.empty());
  EXPECT_TRUE(faults.status());
}

TEST(CheckChange, AnEnumThatHoldsFromStartToEndMayNotChange) {
  EXPECT_TRUE(check_change(Choice{}, Choice{}));
  const auto changed = check_change(Choice{}, Choice{Shape::square});
  EXPECT_EQ(changed.code(), ErrorCode::invalid_parameter);
  EXPECT_EQ(changed.error().message, "shape cannot change at run time: start anew");
}

}  // namespace
}  // namespace goshawk
