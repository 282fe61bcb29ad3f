#include "common/report.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace goshawk::bench {
namespace {

using ::testing::HasSubstr;

Report two_tables() {
  Report report("sample", {});
  report.add({{"table", "one"}, {"map", "office"}, {"median_us", 12.25}});
  report.add({{"table", "two"}, {"count", 3}});
  report.add({{"table", "one"}, {"map", "noise"}, {"median_us", nullptr}});
  report.note("exponent", 1.5);
  return report;
}

TEST(Report, json_has_rows_in_order_notes_and_plots) {
  Report report = two_tables();
  report.draw(Plot{.file = "p", .title = "t", .x = "map", .y = "median_us"});
  const auto json = report.to_json();
  EXPECT_EQ(json["bench"], "sample");
  EXPECT_EQ(json["exponent"], 1.5);
  ASSERT_EQ(json["rows"].size(), 3u);
  EXPECT_EQ(json["rows"][2]["map"], "noise");
  EXPECT_TRUE(json["rows"][2]["median_us"].is_null());
  EXPECT_EQ(json["plots"][0]["file"], "p");
}

TEST(Report, text_has_one_table_for_each_kind_of_row) {
  const std::string text = two_tables().to_text();
  EXPECT_THAT(text, HasSubstr("table  map     median_us\n"
                              "one    office  12.25\n"
                              "one    noise   -\n"));
  EXPECT_THAT(text, HasSubstr("table  count\ntwo    3\n"));
  EXPECT_THAT(text, HasSubstr("exponent: 1.5"));
}

}  // namespace
}  // namespace goshawk::bench
