#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "goshawk/flight_check/config.hpp"
#include "worlds.hpp"

namespace goshawk::flight_check::test {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

class BadInput : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() /
              ("goshawk_flight_check_" +
               std::string(testing::UnitTest::GetInstance()->current_test_info()->name()));
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }

  fs::path write(const std::string& name, const std::string& bytes) const {
    std::ofstream(folder_ / name, std::ios::binary) << bytes;
    return folder_ / name;
  }
  static std::string bytes_of(bool binary) {
    auto tree = tree_of(wall_at_x(3, 6));
    std::ostringstream out;
    if (binary)
      tree->writeBinary(out);
    else
      tree->write(out);
    return out.str();
  }
  static void expect(ErrorCode code, const fs::path& file) {
    const auto check = FlightCheck::open(file);
    ASSERT_FALSE(check.ok()) << file;
    EXPECT_EQ(check.code(), code) << check.error().message;
    EXPECT_THAT(check.error().message, HasSubstr(file.filename().string()));
  }

  fs::path folder_;
};

TEST_F(BadInput, WholeMapsOfBothKindsAreReadAlike) {
  const std::vector<Sample> track{at(0.0, Vec3(-1, 0, 0)), at(1.0, Vec3(0, 0, 0))};
  for (const bool binary : {true, false}) {
    const auto file = write(binary ? "whole.bt" : "whole.ot", bytes_of(binary));
    const auto check = FlightCheck::open(file);
    ASSERT_TRUE(check.ok()) << check.error().message;
    EXPECT_NEAR(check->judge(track)->clearance_m, 0.3 - 0.15, 2e-5);
  }
}

TEST_F(BadInput, MapsThatAreNotThereOrNotMaps) {
  expect(ErrorCode::map_unreadable, folder_ / "missing.bt");
  expect(ErrorCode::map_unreadable, write("cloud.pcd", "VERSION 0.7"));
  fs::create_directories(folder_ / "folder.bt");
  expect(ErrorCode::map_unreadable, folder_ / "folder.bt");
  expect(ErrorCode::map_malformed, write("empty.bt", ""));
  expect(ErrorCode::map_malformed, write("noise.bt", std::string(5000, '\xff')));
  expect(ErrorCode::map_malformed,
         write("other.ot", "# Octomap OcTree file\nid ColorOcTree\nsize 1\nres 0.1\ndata\n"));
  expect(ErrorCode::map_malformed, write("flat.bt", "id OcTree\nsize 3\nres nan\ndata\n12345"));
  expect(ErrorCode::map_empty, write("none.bt", "id OcTree\nsize 0\nres 0.1\ndata\n"));
}

TEST_F(BadInput, MapsCutOffAnywhereAreRefused) {
  for (const bool binary : {true, false}) {
    const std::string whole = bytes_of(binary);
    for (std::size_t length = 0; length < whole.size(); length += 1 + whole.size() / 60) {
      expect(ErrorCode::map_malformed,
             write(binary ? "cut.bt" : "cut.ot", whole.substr(0, length)));
    }
  }
}

TEST_F(BadInput, MapsWithDamagedBytesNeverCrash) {
  Random random(3);
  for (const bool binary : {true, false}) {
    const std::string whole = bytes_of(binary);
    const std::size_t data = whole.find("data\n") + 5;
    int refused = 0;
    for (int k = 0; k < 200; ++k) {
      std::string damaged = whole;
      damaged[data + std::size_t(random.below(int(whole.size() - data)))] ^=
          char(1 << random.below(8));
      refused += !FlightCheck::open(write(binary ? "bad.bt" : "bad.ot", damaged)).ok();
    }
    EXPECT_GT(refused, 20);
  }
}

TEST_F(BadInput, TracksThatMakeNoSenseAreRefusedWithTheSampleNamed) {
  const auto check = FlightCheck::from_tree(tree_of({{0, 0, 0}})).value();
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const Sample good = at(1.0, Vec3(1, 1, 1));
  EXPECT_EQ(check.judge({}).code(), ErrorCode::invalid_input);
  const std::vector<std::pair<Sample, const char*>> bad{
      {at(nan, Vec3(1, 1, 1)), "not finite"},
      {at(2.0, Vec3(1, nan, 1)), "not finite"},
      {at(2.0, Vec3(1, 1, INFINITY)), "not finite"},
      {at(2.0, Vec3(1, 1, 1), Eigen::Quaterniond(nan, 0, 0, 0)), "not finite"},
      {at(2.0, Vec3(1, 1, 1), Eigen::Quaterniond(0, 0, 0, 0)), "unit length"},
      {at(2.0, Vec3(1e9, 1, 1)), "1e6 m"},
      {at(0.5, Vec3(1, 1, 1)), "back in time"}};
  for (const auto& [sample, why] : bad) {
    const std::vector<Sample> track{good, sample};
    const auto verdict = check.judge(track);
    ASSERT_EQ(verdict.code(), ErrorCode::invalid_input) << why;
    EXPECT_THAT(verdict.error().message, HasSubstr(why));
    EXPECT_THAT(verdict.error().message, HasSubstr("sample 1"));
  }
}

TEST_F(BadInput, BodiesAndOptionsOutOfRangeAreRefused) {
  const auto code = [](const Body& body, const Options& options) {
    return FlightCheck::from_tree(tree_of({{0, 0, 0}}), body, options).code();
  };
  EXPECT_EQ(code({.radius_m = 0.0}, {}), ErrorCode::invalid_parameter);
  EXPECT_EQ(code({.radius_m = NAN}, {}), ErrorCode::invalid_parameter);
  EXPECT_EQ(code({.height_m = -1.0}, {}), ErrorCode::invalid_parameter);
  EXPECT_EQ(code({.is_box = true, .width_m = 1e9}, {}), ErrorCode::invalid_parameter);
  EXPECT_EQ(code({}, {.tolerance_m = 0.0}), ErrorCode::invalid_parameter);
  EXPECT_EQ(code({}, {.tolerance_m = NAN}), ErrorCode::invalid_parameter);
  EXPECT_EQ(FlightCheck::from_tree(nullptr).code(), ErrorCode::map_empty);
  EXPECT_EQ(FlightCheck::from_tree(std::make_unique<octomap::OcTree>(0.1)).code(),
            ErrorCode::map_empty);
}

TEST_F(BadInput, AFlightFarBeyondTheMapEnds) {
  const auto v =
      judge(tree_of({{0, 0, 0}}), {at(0.0, Vec3(-1e6, 0.5, 0)), at(1.0, Vec3(1e6, 0.5, 0))});
  EXPECT_FALSE(v.touched);
  EXPECT_NEAR(v.clearance_m, 0.4 - 0.15, 1e-3);
}

TEST_F(BadInput, EveryParameterIsDescribedAndItsDefaultIsInRange) {
  Config config;
  int parameters = 0;
  describe(config, [&](const char*, auto& value, const char*, const char*, const auto& range) {
    ++parameters;
    if constexpr (std::is_same_v<std::decay_t<decltype(range)>, Range>) {
      EXPECT_TRUE(range.contains(value));
    }
  });
  EXPECT_EQ(parameters, 10);
}

}  // namespace
}  // namespace goshawk::flight_check::test
