#include "goshawk/flight_report/page.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>

namespace goshawk::flight_report {
namespace {

namespace fs = std::filesystem;

class Page : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::path(::testing::TempDir()) / "goshawk_page_test";
    fs::create_directories(folder_);
    std::ofstream(page()) << "<before>@FLIGHT@<after>";
  }
  void TearDown() override { fs::remove_all(folder_); }

  fs::path page() const { return folder_ / "page.html"; }
  fs::path file() const { return folder_ / "flight.html"; }
  std::string text() const {
    std::ifstream in(file());
    return {std::istreambuf_iterator<char>(in), {}};
  }

  fs::path folder_;
};

TEST_F(Page, HoldsTheFlightInPlaceOfTheMark) {
  Flight flight;
  flight.title = "A \"flight\" </script>";
  flight.flown = {{0.0, Vec3(1, 2, 3), Vec3(0.5, 0, 0), Eigen::Quaterniond::Identity()},
                  {0.01, Vec3(9, 9, 9), Vec3(0.5, 0, 0), Eigen::Quaterniond::Identity()},
                  {0.02, Vec3(1.25, 2, 3), Vec3(0.5, 0, 0), Eigen::Quaterniond::Identity()}};
  ASSERT_TRUE(write_flight_page(flight, page(), file(), "{\"verdict\":\"<safe>\"}"));
  EXPECT_EQ(text(),
            "<before>{\"title\":\"A \\\"flight\\\" \\u003c/script>\",\"body_radius\":0.15,"
            "\"limits\":{\"v_max\":2.0,\"a_max\":2.0},\"legs\":[],"
            "\"stops\":[[1.0,2.0,3.0],[1.25,2.0,3.0]],\"flown\":{\"t\":[0.0,0.02],"
            "\"p\":[1.0,2.0,3.0,1.25,2.0,3.0],\"v\":[0.5,0.0,0.0,0.5,0.0,0.0],"
            "\"q\":[1.0,0.0,0.0,0.0,1.0,0.0,0.0,0.0]},"
            "\"obstacles\":null,\"grown\":null,\"growth\":null,\"movers\":[],\"predictions\":[],"
            "\"summary\":{\"verdict\":\"\\u003csafe>\"}}<after>");
}

TEST_F(Page, WritesTheMapAsRuns) {
  VoxelGrid grid;
  grid.geometry = {Vec3::Zero(), 0.5, {3, 2, 1}};
  grid.grown = BitGrid({3, 2, 1}, true);
  grid.grown.set({2, 0, 0}, true);
  grid.grown.set({0, 1, 0}, true);
  Flight flight;
  flight.obstacles = &grid;
  ASSERT_TRUE(write_flight_page(flight, page(), file()));
  // Two free, two occupied, two free: bytes 2 2 2.
  EXPECT_NE(
      text().find("\"obstacles\":{\"origin\":[0.0,0.0,0.0],\"resolution\":0.5,\"size\":[3,2,1],"
                  "\"runs\":\"AgIC\"}"),
      std::string::npos)
      << text();
}

TEST_F(Page, SaysWhatIsWrong) {
  Flight flight;
  EXPECT_EQ(write_flight_page(flight, page(), file()).code(), ErrorCode::invalid_input);
  flight.flown = {{0.0, Vec3(1, 2, 3), Vec3::Zero(), Eigen::Quaterniond::Identity()}};
  EXPECT_EQ(write_flight_page(flight, folder_ / "none.html", file()).code(), ErrorCode::io_failed);
  std::ofstream(folder_ / "other.html") << "no mark";
  EXPECT_EQ(write_flight_page(flight, folder_ / "other.html", file()).code(), ErrorCode::io_failed);
  EXPECT_EQ(write_flight_page(flight, page(), file(), "{").code(), ErrorCode::invalid_input);
  EXPECT_EQ(write_flight_page(flight, page(), "/dev/full").code(), ErrorCode::io_failed);
  EXPECT_EQ(write_flight_page(flight, page(), folder_ / "no" / "x").code(), ErrorCode::io_failed);
}

}  // namespace
}  // namespace goshawk::flight_report
