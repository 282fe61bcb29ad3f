#include "goshawk/sensors/firing_pattern.hpp"

#include <gtest/gtest.h>

#include <set>

#include "support.hpp"

namespace goshawk::sensors {
namespace {

FiringPattern pattern_of(Preset preset) {
  return FiringPattern(perfect(preset).pattern);
}

double azimuth(const Firing& f) {
  return std::atan2(f.direction_sensor.y(), f.direction_sensor.x());
}
double elevation(const Firing& f) {
  return std::asin(f.direction_sensor.z());
}

TEST(FiringPattern, Vlp16HasSixteenChannelsTwoDegreesApartThatFireInTurn) {
  const auto pattern = pattern_of(Preset::vlp16);
  EXPECT_EQ(pattern.firings(), 16 * 1808);
  EXPECT_EQ(pattern.period_ns(), 100'000'000);
  for (int i = 0; i < 64; ++i) {
    const Firing f = pattern.at(0, i);
    EXPECT_EQ(f.ring, i % 16);
    EXPECT_NEAR(elevation(f), (-15.0 + 2.0 * f.ring) * kDegree, 1e-9);
    // 55.3 us a column, spread over its channels.
    EXPECT_NEAR(double(f.offset_ns), i * 1e8 / (16 * 1808), 1.0);
  }
}

TEST(FiringPattern, SpinningTurnsClockwiseFromBehindOverTheFront) {
  for (const Preset preset : {Preset::vlp16, Preset::os0_128, Preset::os1_128}) {
    const auto pattern = pattern_of(preset);
    EXPECT_NEAR(std::abs(azimuth(pattern.at(0, 0))), kPi, 1e-9);
    EXPECT_NEAR(azimuth(pattern.at(0, pattern.firings() / 2)), 0.0, 1e-9);
    double before = kPi + 1e-9;
    std::int64_t offset_ns = 0;
    for (int i = 0; i < pattern.firings(); i += pattern.neighbour()) {
      const Firing f = pattern.at(0, i);
      const double now = i == 0 ? kPi : azimuth(f);
      ASSERT_LT(now, before) << i;
      ASSERT_GE(f.offset_ns, offset_ns);
      before = now, offset_ns = f.offset_ns;
    }
    EXPECT_LT(offset_ns, pattern.period_ns());
  }
}

TEST(FiringPattern, OusterFiresAllChannelsOfAColumnAtOnce) {
  const auto pattern = pattern_of(Preset::os1_128);
  for (int i = 0; i < 128; ++i) {
    const Firing f = pattern.at(0, 128 * 5 + i);
    EXPECT_EQ(f.offset_ns, 5 * 100'000'000LL / 1024);
    EXPECT_NEAR(elevation(f), (-22.5 + 45.0 * i / 127) * kDegree, 1e-9);
  }
}

TEST(FiringPattern, ASectorIsCentredOnTheXAxis) {
  auto p = perfect(Preset::vlp16).pattern;
  p.azimuth_width_rad = 1.0;
  p.channels = 1;
  p.elevation_lower_rad = p.elevation_upper_rad = 0.1;
  const FiringPattern pattern(p);
  EXPECT_NEAR(azimuth(pattern.at(0, 0)), 0.5, 1e-9);
  EXPECT_NEAR(azimuth(pattern.at(0, pattern.firings() - 1)), -0.5, 1e-3);
  EXPECT_NEAR(elevation(pattern.at(0, 7)), 0.1, 1e-9);
}

TEST(FiringPattern, EveryDirectionHasLengthOneAndEveryTimeIsWithinTheScan) {
  for (const auto& named : words_of(Preset{})) {
    const auto pattern = pattern_of(named.value);
    for (int i = 0; i < pattern.firings(); i += 17) {
      const Firing f = pattern.at(3, i);
      ASSERT_NEAR(f.direction_sensor.norm(), 1.0, 1e-12) << named.word;
      ASSERT_GE(f.offset_ns, 0);
      ASSERT_LT(f.offset_ns, pattern.period_ns());
    }
  }
}

TEST(FiringPattern, Mid360CoversItsFieldAndFires200000TimesASecond) {
  const auto pattern = pattern_of(Preset::mid360);
  EXPECT_EQ(pattern.firings(), 20'000);
  double lowest = 9.0, highest = -9.0;
  std::set<int> sectors;
  for (int i = 0; i < pattern.firings(); ++i) {
    const Firing f = pattern.at(0, i);
    lowest = std::min(lowest, elevation(f)), highest = std::max(highest, elevation(f));
    sectors.insert(int(std::floor(azimuth(f) / (5.0 * kDegree))));
  }
  EXPECT_GE(lowest, -7.01 * kDegree);
  EXPECT_LT(lowest, -5.0 * kDegree);
  EXPECT_LE(highest, 52.01 * kDegree);
  EXPECT_GT(highest, 50.0 * kDegree);
  EXPECT_EQ(sectors.size(), 72U) << "all around";
}

TEST(FiringPattern, AviaLooksForwardWithSixLasersAtOnce) {
  const auto pattern = pattern_of(Preset::avia);
  EXPECT_EQ(pattern.firings(), 24'000);
  for (int i = 0; i < pattern.firings(); ++i) {
    const Firing f = pattern.at(0, i);
    ASSERT_LT(std::abs(azimuth(f)), 0.5 * 70.4 * kDegree);
    ASSERT_LT(std::abs(elevation(f)), 0.5 * 77.2 * kDegree);
  }
  const Firing first = pattern.at(0, 600), last = pattern.at(0, 605);
  EXPECT_EQ(first.offset_ns, last.offset_ns);
  EXPECT_NEAR(elevation(last) - elevation(first), 5 * 1.4 * kDegree, 1e-9);
}

// Cells of half a degree that the scans have seen by then: a pattern that does not repeat sees more
// and more.
std::size_t cells_seen(const FiringPattern& pattern, int scans) {
  std::set<std::pair<int, int>> cells;
  for (int scan = 0; scan < scans; ++scan) {
    for (int i = 0; i < pattern.firings(); ++i) {
      const Firing f = pattern.at(scan, i);
      cells.emplace(std::lround(2.0 * azimuth(f) / kDegree),
                    std::lround(2.0 * elevation(f) / kDegree));
    }
  }
  return cells.size();
}

TEST(FiringPattern, SolidStatePatternsDoNotRepeat) {
  for (const Preset preset : {Preset::mid360, Preset::avia}) {
    const auto pattern = pattern_of(preset);
    EXPECT_GT(double(cells_seen(pattern, 4)), 1.2 * double(cells_seen(pattern, 1)))
        << to_word(preset);
  }
  const auto vlp16 = pattern_of(Preset::vlp16);
  EXPECT_EQ(cells_seen(vlp16, 2), cells_seen(vlp16, 1));
}

TEST(FiringPattern, PixelsProjectBackThroughThePinhole) {
  const auto p = perfect(Preset::d435).pattern;
  const FiringPattern pattern(p);
  const Pinhole camera = Pinhole::of(p);
  EXPECT_EQ(pattern.firings(), 212 * 120);
  EXPECT_NEAR(2.0 * std::atan(106.0 / camera.focal), 87.0 * kDegree, 1e-6);
  for (int i = 0; i < pattern.firings(); i += 31) {
    const Vec3 d = pattern.at(0, i).direction_sensor;
    EXPECT_NEAR(camera.center_x - camera.focal * d.y() / d.x(), i % 212, 1e-9);
    EXPECT_NEAR(camera.center_y - camera.focal * d.z() / d.x(), i / 212, 1e-9);
  }
}

}  // namespace
}  // namespace goshawk::sensors
