// The picture of a map that grows: what is in it, by its pixels.
#include "goshawk/flight_report/growth.hpp"

#include <cairo.h>
#include <gtest/gtest.h>

#include <limits>

namespace goshawk::flight_report::test {
namespace {

namespace fs = std::filesystem;

/// How many pixels of a PNG have exactly this colour, 0xRRGGBB.
int pixels_of(const fs::path& png, std::uint32_t color) {
  cairo_surface_t* surface = cairo_image_surface_create_from_png(png.c_str());
  EXPECT_EQ(cairo_surface_status(surface), CAIRO_STATUS_SUCCESS);
  const int width = cairo_image_surface_get_width(surface);
  const int height = cairo_image_surface_get_height(surface);
  const unsigned char* data = cairo_image_surface_get_data(surface);
  int count = 0;
  for (int y = 0; y < height; ++y) {
    const auto* row = reinterpret_cast<const std::uint32_t*>(
        data + std::ptrdiff_t(y) * cairo_image_surface_get_stride(surface));
    for (int x = 0; x < width; ++x) count += (row[x] & 0xFFFFFFU) == color ? 1 : 0;
  }
  cairo_surface_destroy(surface);
  return count;
}

/// A window of 20 x 10 x 4 voxels of 1 m whose first columns are known; one of them is blocked.
MapMoment moment(double t_s, int known_columns) {
  MapMoment m;
  m.t_s = t_s;
  m.grid.geometry = {Vec3::Zero(), 1.0, {20, 10, 4}};
  m.grid.grown = BitGrid(m.grid.geometry.size, true, false);
  m.grid.known = BitGrid(m.grid.geometry.size, false);
  for (int x = 0; x < known_columns; ++x) {
    for (int y = 0; y < 10; ++y) {
      for (int z = 0; z < 4; ++z) {
        m.grid.known.set({x, y, z}, true);
        m.grid.grown.set({x, y, z}, x == 2 || z == 0);  // a wall, and the floor
      }
    }
  }
  m.track_map = {Vec3(0.5, 5.0, 2.5), Vec3(0.5 + 0.5 * t_s, 5.0, 2.5)};
  return m;
}

constexpr std::uint32_t kUnseen = 0xBDBDB8, kLearnt = 0xB8DBF5, kLearntBlocked = 0xD65E00;
constexpr std::uint32_t kBlocked = 0x475261;

class Growth : public testing::Test {
 protected:
  void TearDown() override { fs::remove(png_); }
  const fs::path png_ = fs::temp_directory_path() / "goshawk_growth_test.png";
};

TEST_F(Growth, ShowsWhatIsKnownAndWhatWasLearntSinceThePanelBefore) {
  const std::vector<MapMoment> moments{moment(0.0, 6), moment(4.0, 12)};
  ASSERT_TRUE(draw_growth({moments.data(), 1}, png_));
  const int learnt = pixels_of(png_, kLearnt), unseen = pixels_of(png_, kUnseen);
  // 5 of 20 columns became free, 1 blocked, 14 are unknown; lines and letters cover some.
  EXPECT_GT(learnt, 10'000);
  EXPECT_NEAR(double(unseen) / learnt, 14.0 / 5.0, 0.5);
  EXPECT_GT(pixels_of(png_, kLearntBlocked), 2'000);
  EXPECT_LT(pixels_of(png_, kBlocked), 1'000);  // of the legend; the floor does not count

  ASSERT_TRUE(draw_growth(moments, png_));
  EXPECT_GT(pixels_of(png_, kBlocked), 2'000);  // the wall is old in the second panel
  EXPECT_NEAR(double(pixels_of(png_, kLearnt)) / learnt, 11.0 / 5.0, 0.4);
}

TEST_F(Growth, ObstaclesAsMeasuredAtTheHeightFlownNearbyAreDrawn) {
  MapMoment climbs = moment(0.0, 20);
  climbs.grid.raw = BitGrid(climbs.grid.geometry.size, false);
  for (int y = 0; y < 10; ++y) {
    climbs.grid.raw.set({4, y, 1}, true);   // below the flight there
    climbs.grid.raw.set({15, y, 3}, true);  // at its height there
  }
  climbs.track_map.clear();
  for (int x = 0; x < 20; ++x) climbs.track_map.emplace_back(x + 0.5, 5.0, x < 10 ? 2.5 : 3.5);
  ASSERT_TRUE(draw_growth({&climbs, 1}, png_));
  const int one_column = pixels_of(png_, kLearntBlocked), learnt = pixels_of(png_, kLearnt);
  EXPECT_NEAR(double(learnt) / one_column, 19.0, 4.0);  // the wall at x = 2 is grown, not measured
}

TEST_F(Growth, AWindowThatMovedIsDrawnInItsPlace) {
  std::vector<MapMoment> moments{moment(0.0, 6), moment(4.0, 6)};
  moments[1].grid.geometry.origin_map = Vec3(20.0, 0.0, 0.0);
  ASSERT_TRUE(draw_growth(moments, png_));
  // The same columns elsewhere: learnt in both panels, and nothing is old.
  EXPECT_LT(pixels_of(png_, kBlocked), 1'000);
}

TEST_F(Growth, RefusesWhatCannotBeDrawn) {
  EXPECT_EQ(draw_growth({}, png_).code(), ErrorCode::invalid_input);
  EXPECT_EQ(draw_growth(std::vector<MapMoment>(13, moment(0.0, 1)), png_).code(),
            ErrorCode::invalid_input);
  std::vector<MapMoment> moments{moment(0.0, 1)};
  EXPECT_EQ(draw_growth(moments, "/no/such/folder/a.png").code(), ErrorCode::io_failed);
  moments[0].track_map.push_back(Vec3(std::numeric_limits<double>::quiet_NaN(), 0.0, 0.0));
  EXPECT_EQ(draw_growth(moments, png_).code(), ErrorCode::invalid_input);
  EXPECT_EQ(draw_growth(std::vector<MapMoment>(1), png_).code(), ErrorCode::invalid_input);
}

}  // namespace
}  // namespace goshawk::flight_report::test
