#include "goshawk/sensors/parameters.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support.hpp"

namespace goshawk::sensors {
namespace {

using testing::HasSubstr;

TEST(Parameters, EveryPresetIsValid) {
  for (const auto& named : words_of(Preset{})) {
    SensorParameters p;
    apply_preset(named.value, p);
    EXPECT_EQ(p.preset, named.value);
    const auto status = check(p);
    EXPECT_TRUE(status) << named.word << ": " << status.error().message;
  }
}

TEST(Parameters, TheDefaultsAreThoseOfTheDefaultPreset) {
  SensorParameters preset;
  apply_preset(SensorParameters{}.preset, preset);
  const SensorParameters defaults;
  std::vector<double> a, b;
  const auto list = [](std::vector<double>& values) {
    return [&values](const char*, const auto& value, const char*, const char*, const auto&) {
      values.push_back(double(value));
    };
  };
  describe(defaults, list(a));
  describe(std::as_const(preset), list(b));
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) EXPECT_NEAR(a[i], b[i], 1e-6) << "parameter " << i;
}

/// Writes as the reader of parameters does: in the order of describe().
struct Writer {
  Preset preset;
  double noise_m;
  void operator()(const char* name, Preset& value, const char*, const char*, const Anything&) {
    if (std::string(name) == "preset") value = preset;
  }
  template <typename T, typename Allowed>
  void operator()(const char* name, T& value, const char*, const char*, const Allowed&) {
    if constexpr (std::is_same_v<T, double>) {
      if (std::string(name) == "range_noise_m") value = noise_m;
    }
  }
};

TEST(Parameters, WhatIsGivenBesideAPresetPrevails) {
  SensorParameters p;
  describe(p, Writer{Preset::mid360, 0.5});
  EXPECT_EQ(p.pattern.pattern, Pattern::mid360);
  EXPECT_EQ(p.returns.range_max_m, 40.0);
  EXPECT_EQ(p.returns.range_noise_m, 0.5);
  // The preset that stands already changes nothing: values may be set at run time.
  p.returns.range_max_m = 12.0;
  describe(p, Writer{Preset::mid360, 0.25});
  EXPECT_EQ(p.returns.range_max_m, 12.0);
  EXPECT_EQ(p.returns.range_noise_m, 0.25);
}

void expect_refused(const SensorParameters& p, const std::string& words) {
  const auto sensor = Sensor::create(p);
  ASSERT_FALSE(sensor) << words;
  EXPECT_EQ(sensor.code(), ErrorCode::invalid_parameter);
  EXPECT_THAT(sensor.error().message, HasSubstr(words));
}

TEST(Parameters, EachUnusableValueIsRefusedWithItsName) {
  const double nan = std::nan("");
  SensorParameters p;
  const auto with = [](auto&& change) {
    SensorParameters changed;
    change(changed);
    return changed;
  };
  expect_refused(with([](auto& s) { s.pattern.channels = 0; }), "channels is 0");
  expect_refused(with([](auto& s) { s.pattern.columns = 0; }), "columns is 0");
  expect_refused(with([](auto& s) { s.pattern.rate_hz = 0.0; }), "rate_hz is 0");
  // The points of a scan that lasts longer than 1 s are too old for a map.
  expect_refused(with([](auto& s) { s.pattern.rate_hz = 0.9; }), "rate_hz is 0.9");
  expect_refused(with([&](auto& s) { s.pattern.rate_hz = nan; }), "rate_hz is nan");
  expect_refused(with([](auto& s) { s.pattern.azimuth_width_rad = 0.0; }),
                 "azimuth_width_rad is 0");
  expect_refused(with([](auto& s) { s.pattern.width = -1; }), "width is -1");
  expect_refused(with([](auto& s) { s.pattern.horizontal_view_rad = 3.2; }), "horizontal_view_rad");
  expect_refused(with([&](auto& s) { s.returns.range_noise_m = nan; }), "range_noise_m is nan");
  expect_refused(with([](auto& s) { s.returns.range_noise_m = -0.1; }), "range_noise_m is -0.1");
  expect_refused(with([](auto& s) { s.returns.missing_share = 1.1; }), "missing_share is 1.1");
  expect_refused(with([&](auto& s) { s.mount.z_m = nan; }), "mount_z_m is nan");
  expect_refused(with([](auto& s) { s.latency_s = -0.1; }), "latency_s is -0.1");
  expect_refused(with([](auto& s) { s.drop_share = 2.0; }), "drop_share is 2");
  expect_refused(with([](auto& s) { s.pattern.pattern = Pattern(9); }), "pattern is 9");
}

TEST(Parameters, ValuesThatDisagreeAreRefused) {
  SensorParameters p;
  p.returns.range_min_m = 100.0;
  expect_refused(p, "range_min_m is 100 m and must be below range_max_m, 100 m");
  p = {};
  p.pattern.elevation_lower_rad = 0.5;
  expect_refused(p, "elevation_lower_rad is 0.5 and must not be above elevation_upper_rad");
  p = {};
  p.pattern.channels = 1024, p.pattern.columns = 65536;
  expect_refused(p, "6.71e+08 rays a second are asked for");
}

TEST(Parameters, EveryFaultIsNamedAtOnce) {
  SensorParameters p;
  p.pattern.channels = 0;
  p.returns.false_share = -1.0;
  expect_refused(p, "channels is 0");
  expect_refused(p, "false_share is -1");
}

}  // namespace
}  // namespace goshawk::sensors
