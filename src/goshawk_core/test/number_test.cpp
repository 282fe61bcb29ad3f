#include "goshawk/core/number.hpp"

#include <gtest/gtest.h>

namespace goshawk {
namespace {

TEST(FiniteNumber, IsTheWholeText) {
  EXPECT_EQ(finite_number("2.5"), 2.5);
  EXPECT_EQ(finite_number("-1e3"), -1000.0);
  EXPECT_EQ(finite_number("+4"), 4.0);
  EXPECT_EQ(finite_number(std::string_view("12345", 2)), 12.0);
}

TEST(FiniteNumber, AnyOtherTextIsNone) {
  for (const char* text : {"", "+", "-", "+-5", "++5", "3 m", " 3", "3 ", "1,5", "0x10", "nan",
                           "inf", "-inf", "1e999", "high"}) {
    EXPECT_FALSE(finite_number(text)) << text;
  }
}

}  // namespace
}  // namespace goshawk
