// The pictures are made, hold what they should, and tell what is wrong if they cannot be made.
#include "goshawk/flight_report/draw.hpp"

#include <cairo.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <set>

#include "goshawk/flight_report/files.hpp"
#include "sample_flight.hpp"

namespace goshawk::flight_report::test {
namespace {

namespace fs = std::filesystem;

struct Picture {
  int width = 0;
  int height = 0;
  std::vector<std::uint32_t> pixels;  // 0xRRGGBB

  std::size_t colors() const { return std::set(pixels.begin(), pixels.end()).size(); }
  /// How many pixels are within `near` of a colour in every channel.
  int count(int r, int g, int b, int near = 6) const {
    return int(std::count_if(pixels.begin(), pixels.end(), [=](std::uint32_t p) {
      return std::abs(int(p >> 16) - r) <= near && std::abs(int(p >> 8 & 255U) - g) <= near &&
             std::abs(int(p & 255U) - b) <= near;
    }));
  }
};

Picture read(const fs::path& png) {
  cairo_surface_t* surface = cairo_image_surface_create_from_png(png.c_str());
  Picture picture;
  if (cairo_surface_status(surface) == CAIRO_STATUS_SUCCESS) {
    picture.width = cairo_image_surface_get_width(surface);
    picture.height = cairo_image_surface_get_height(surface);
    const unsigned char* data = cairo_image_surface_get_data(surface);
    const int stride = cairo_image_surface_get_stride(surface);
    for (int y = 0; y < picture.height; ++y) {
      const auto* row = reinterpret_cast<const std::uint32_t*>(data + std::ptrdiff_t(y) * stride);
      for (int x = 0; x < picture.width; ++x) picture.pixels.push_back(row[x] & 0xFFFFFFU);
    }
  }
  cairo_surface_destroy(surface);
  return picture;
}

std::string bytes(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

class Draw : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() /
              ("goshawk_flight_report_" +
               std::string(testing::UnitTest::GetInstance()->current_test_info()->name()));
    fs::remove_all(folder_);
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }

  Picture top(const Flight& flight) const { return drawn(draw_top, flight); }
  Picture side(const Flight& flight) const { return drawn(draw_side, flight); }
  Picture time(const Flight& flight) const { return drawn(draw_time, flight); }

  Picture drawn(Status (*draw)(const Flight&, const fs::path&), const Flight& flight) const {
    const auto status = draw(flight, folder_ / "x.png");
    EXPECT_TRUE(status.ok()) << (status ? "" : status.error().message);
    return status ? read(folder_ / "x.png") : Picture{};
  }

  fs::path folder_;
};

TEST_F(Draw, EveryPictureHasItsSizeAndItsColors) {
  const SampleFlight sample;
  const Picture a = top(sample.flight), b = side(sample.flight), c = time(sample.flight);
  for (const Picture* picture : {&a, &b, &c}) {
    EXPECT_GT(picture->width, 1300);
    EXPECT_LE(picture->width, 1400);
    EXPECT_GT(picture->height, 300);
    EXPECT_LE(picture->height, 1300);
    EXPECT_GT(picture->colors(), 200U);
  }
  EXPECT_GT(a.count(26, 153, 64), 150);       // the start's disc
  EXPECT_GT(a.count(204, 26, 26), 300);       // two goals
  EXPECT_GT(a.count(71, 82, 97), 5000);       // obstacles at the height flown
  EXPECT_GT(a.count(251, 228, 201), 5000);    // grown ones
  EXPECT_GT(c.count(204, 31, 31, 20), 1000);  // the two limit lines
}

TEST_F(Draw, ObstaclesAreDarkOnlyAtTheHeightThatIsFlown) {
  VoxelGrid grid;
  grid.geometry = {Vec3::Zero(), 0.1, {60, 60, 30}};
  grid.grown = BitGrid(grid.geometry.size, true);
  for (int z = 0; z < 15; ++z) {  // a box up to z = 1.5 m
    for (int y = 20; y < 40; ++y) grid.grown.set_run(20, 40, y, z, true);
  }
  const auto flying_at = [&](double z_m) {
    Flight flight;
    flight.obstacles = &grid;
    flight.flown = {{0.0, Vec3(0.5, 1.5, z_m), Vec3::UnitX()},
                    {5.0, Vec3(5.5, 1.5, z_m), Vec3::UnitX()}};
    return top(flight);
  };
  const Picture low = flying_at(1.0), high = flying_at(2.5);
  const int dark = low.count(71, 82, 97);
  EXPECT_GT(dark, 40000);  // 2 x 1 m of it are in the window, at some 176 pixels a metre
  EXPECT_LT(high.count(71, 82, 97), 1000);
}

TEST_F(Draw, TheSamePictureTwiceIsTheSameBytes) {
  const SampleFlight sample;
  for (const auto draw : {draw_top, draw_side, draw_time}) {
    ASSERT_TRUE(draw(sample.flight, folder_ / "a.png").ok());
    ASSERT_TRUE(draw(sample.flight, folder_ / "b.png").ok());
    EXPECT_EQ(bytes(folder_ / "a.png"), bytes(folder_ / "b.png"));
  }
}

TEST_F(Draw, WhateverPartOfAFlightThereIs) {
  const SampleFlight sample;
  Flight map_only;
  map_only.obstacles = &sample.obstacles;
  Flight path_only;
  path_only.legs = {{.raw_path_map = {Vec3(0, 0, 1), Vec3(1, 2, 1)},
                     .waypoints_map = {},
                     .corridor = {},
                     .trajectory = {}}};
  Flight point_only;
  point_only.flown = {{3.0, Vec3(1, 1, 1), Vec3::Zero()}};
  Flight wide;
  wide.flown = {{0.0, Vec3(-1e6, 0, 0), Vec3::Zero()}, {1.0, Vec3(1e6, 1, 0), Vec3::Zero()}};
  wide.grown = &sample.grown;
  Flight tall;
  tall.flown = {{0.0, Vec3(0, 0, 0), Vec3::Zero()}, {1e9, Vec3(0, 1e6, 3), Vec3::Zero()}};
  Flight open_corridor = path_only;
  open_corridor.legs[0].corridor.resize(1);
  open_corridor.legs[0].corridor[0].add(Vec3::UnitX(), 0.5);
  for (const Flight* flight : {&map_only, &path_only, &point_only, &wide, &tall, &open_corridor}) {
    EXPECT_GT(top(*flight).colors(), 20U);
    EXPECT_GT(side(*flight).colors(), 20U);
  }
  EXPECT_GT(time(point_only).colors(), 20U);
  EXPECT_GT(time(tall).colors(), 20U);
  EXPECT_EQ(draw_time(path_only, folder_ / "x.png").code(), ErrorCode::invalid_input);
}

TEST_F(Draw, BadFlightsAreRefusedWithTheirFault) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const SampleFlight sample;
  const auto fault = [&](auto&& spoil) {
    Flight flight = sample.flight;
    spoil(flight);
    const auto status = draw_top(flight, folder_ / "x.png");
    EXPECT_EQ(status.code(), ErrorCode::invalid_input);
    EXPECT_FALSE(fs::exists(folder_ / "x.png"));
    return status ? std::string() : status.error().message;
  };
  using testing::HasSubstr;
  EXPECT_THAT(fault([](Flight& f) { f = {}; }), HasSubstr("no map, no path and no track"));
  EXPECT_THAT(fault([&](Flight& f) { f.flown[7].position_map.y() = nan; }), HasSubstr("sample 7"));
  EXPECT_THAT(fault([&](Flight& f) { f.flown[9].t_s = -1.0; }), HasSubstr("back in time"));
  EXPECT_THAT(fault([&](Flight& f) { f.legs[1].waypoints_map[0].z() = nan; }), HasSubstr("leg 1"));
  EXPECT_THAT(fault([&](Flight& f) { f.legs[0].raw_path_map[0].z() = 1e8; }), HasSubstr("leg 0"));
  EXPECT_THAT(fault([&](Flight& f) { f.legs[0].start_t_s = nan; }), HasSubstr("start time"));
  EXPECT_THAT(fault([&](Flight& f) { f.legs[0].corridor[0].half_spaces[0].offset_m = nan; }),
              HasSubstr("polytope"));
  EXPECT_THAT(fault([&](Flight& f) { f.legs[0].trajectory.pieces[0].duration_s = 0.0; }),
              HasSubstr("trajectory"));
  EXPECT_THAT(fault([&](Flight& f) { f.legs[1].yaw_rad = nan; }), HasSubstr("leg 1 has a yaw"));
  EXPECT_THAT(fault([&](Flight& f) { f.legs[1].yaw_curve = YawCurve{}; }), HasSubstr("yaw curve"));
  EXPECT_THAT(fault([&](Flight& f) { f.limits.v_max_m_s = 0.0; }), HasSubstr("cannot be drawn"));
  EXPECT_THAT(fault([&](Flight& f) { f.body_radius_m = nan; }), HasSubstr("radius"));
  VoxelGrid broken = sample.obstacles;
  broken.geometry.size.x += 1;
  EXPECT_THAT(fault([&](Flight& f) { f.obstacles = &broken; }), HasSubstr("obstacles"));
}

TEST_F(Draw, FoldersThatCannotBeWrittenAreNamed) {
  const SampleFlight sample;
  const auto message = [&](const fs::path& png) {
    const auto status = draw_top(sample.flight, png);
    EXPECT_EQ(status.code(), ErrorCode::io_failed);
    return status ? std::string() : status.error().message;
  };
  EXPECT_THAT(message(folder_ / "missing" / "top.png"), testing::HasSubstr("missing/top.png"));
  EXPECT_THAT(message(folder_), testing::HasSubstr("cannot open"));
  if (fs::exists("/dev/full")) {
    fs::create_symlink("/dev/full", folder_ / "full.png");
    EXPECT_THAT(message(folder_ / "full.png"), testing::HasSubstr("disk is not full"));
  }
  EXPECT_EQ(write_flight_folder(sample.flight, folder_ / "missing").code(), ErrorCode::io_failed);
}

TEST_F(Draw, MissingFontsDoNotStopIt) {
  const SampleFlight sample;
  const fs::path png = folder_ / "plain.png";
  // In a process of its own, before any font was looked up.
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  EXPECT_EXIT(
      {
        setenv("FONTCONFIG_FILE", "/nonexistent", 1);
        std::exit(draw_top(sample.flight, png).ok() ? 0 : 1);
      },
      testing::ExitedWithCode(0), "");
  EXPECT_GT(read(png).colors(), 100U);
}

}  // namespace
}  // namespace goshawk::flight_report::test
