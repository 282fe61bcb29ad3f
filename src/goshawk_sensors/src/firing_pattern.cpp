#include "goshawk/sensors/firing_pattern.hpp"

#include <cmath>

namespace goshawk::sensors {
namespace {

constexpr double kPi = std::numbers::pi;

// MARSIM's lasers: Mid-360 fires one every 5 us, Avia all six every 25 us.
constexpr std::int64_t kMid360_ns = 5'000;
constexpr int kMid360Lasers = 4;
constexpr std::int64_t kAvia_ns = 25'000;
constexpr int kAviaLasers = 6;

Vec3 direction(double azimuth_rad, double elevation_rad) {
  const double level = std::cos(elevation_rad);
  return {level * std::cos(azimuth_rad), level * std::sin(azimuth_rad), std::sin(elevation_rad)};
}

}  // namespace

Pinhole Pinhole::of(const PatternParameters& p) {
  return {0.5 * p.width / std::tan(0.5 * p.horizontal_view_rad), 0.5 * (p.width - 1),
          0.5 * (p.height - 1)};
}

FiringPattern::FiringPattern(const PatternParameters& parameters)
    : parameters_(parameters), period_ns_(std::llround(1e9 / parameters.rate_hz)) {
  switch (parameters.pattern) {
    case Pattern::spinning:
      fill_spinning();
      return;
    case Pattern::depth_camera:
      fill_camera();
      return;
    case Pattern::mid360:
      firings_ = int(period_ns_ / kMid360_ns);
      neighbour_ = kMid360Lasers;
      return;
    case Pattern::avia:
      firings_ = int(period_ns_ / kAvia_ns) * kAviaLasers;
      neighbour_ = kAviaLasers;
      return;
  }
}

Firing FiringPattern::at(std::int64_t scan, int i) const {
  if (!table_.empty()) return table_[std::size_t(i)];
  return parameters_.pattern == Pattern::mid360 ? mid360(scan, i) : avia(scan, i);
}

void FiringPattern::fill_spinning() {
  const PatternParameters& p = parameters_;
  firings_ = p.columns * p.channels;
  neighbour_ = p.channels;
  table_.reserve(std::size_t(firings_));
  const double step =
      p.channels > 1 ? (p.elevation_upper_rad - p.elevation_lower_rad) / (p.channels - 1) : 0.0;
  for (int column = 0; column < p.columns; ++column) {
    for (int channel = 0; channel < p.channels; ++channel) {
      const std::int64_t place =
          std::int64_t{column} * p.channels + (p.channels_together ? 0 : channel);
      const double azimuth = p.azimuth_width_rad * (0.5 - double(place) / firings_);
      table_.push_back({direction(azimuth, p.elevation_lower_rad + channel * step),
                        period_ns_ * place / firings_, std::uint16_t(channel)});
    }
  }
}

void FiringPattern::fill_camera() {
  const PatternParameters& p = parameters_;
  firings_ = p.width * p.height;
  table_.reserve(std::size_t(firings_));
  const Pinhole camera = Pinhole::of(p);
  for (int v = 0; v < p.height; ++v) {
    for (int u = 0; u < p.width; ++u) {
      const Vec3 ray(camera.focal, camera.center_x - u, camera.center_y - v);
      table_.push_back({ray.normalized(), 0, std::uint16_t(v)});
    }
  }
}

Firing FiringPattern::mid360(std::int64_t scan, int i) const {
  const double t = double(scan * firings_ + i) * double(kMid360_ns) * 1e-9;
  const double azimuth = 62050.63 * t - 3.11 * std::cos(314159.2 * t) * std::sin(1256.636 * t);
  const double elevation = 22.5 + 25.5 * std::cos(20.0 * kPi * t) +
                           4.0 * std::cos(2.0 * kPi * t / 0.006) * std::cos(10000.0 * kPi * t);
  return {direction(kDegree * azimuth, kDegree * elevation), i * kMid360_ns,
          std::uint16_t(i % kMid360Lasers)};
}

Firing FiringPattern::avia(std::int64_t scan, int i) const {
  const int laser = i % kAviaLasers;
  const double t = double((scan * firings_ + i) / kAviaLasers) * double(kAvia_ns) * 1e-9;
  const double a = 763.826 * t, b = -488.413 * t;
  const double azimuth = 0.24 * 70.4 * (std::cos(a) + std::cos(b));
  const double elevation = 0.215 * 77.2 * (std::sin(a) + std::sin(b)) + 1.4 * (laser - 2.5);
  return {direction(kDegree * azimuth, kDegree * elevation), i / kAviaLasers * kAvia_ns,
          std::uint16_t(laser)};
}

}  // namespace goshawk::sensors
