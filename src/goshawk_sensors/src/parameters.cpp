#include "goshawk/sensors/parameters.hpp"

#include <fmt/format.h>

namespace goshawk::sensors {
namespace {

constexpr double kMostRays_1_s = 2e7;

PatternParameters spinning(int channels, int columns, double half_view_deg, bool together) {
  PatternParameters p;
  p.channels = channels;
  p.columns = columns;
  p.elevation_lower_rad = -half_view_deg * kDegree;
  p.elevation_upper_rad = half_view_deg * kDegree;
  p.channels_together = together;
  return p;
}

PatternParameters other(Pattern pattern, double rate_hz) {
  PatternParameters p;
  p.pattern = pattern;
  p.rate_hz = rate_hz;
  return p;
}

ReturnParameters ranges(double min_m, double max_m, double noise_m) {
  ReturnParameters r;
  r.range_min_m = min_m;
  r.range_max_m = max_m;
  r.range_noise_m = noise_m;
  return r;
}

// D435 at 848 x 480, reduced by 4: focal length 424 pixels, baseline 50 mm, 0.08 pixels of error in
// disparity.
ReturnParameters d435_returns() {
  ReturnParameters r = ranges(0.28, 10.0, 0.0);
  r.range_noise_square_1_m = 0.08 / (424.0 * 0.05);
  r.edge_share = 0.5;
  r.edge_depth_m = 10.0;
  return r;
}

ReturnParameters mid360_returns() {
  ReturnParameters r = ranges(0.1, 40.0, 0.02);
  r.angle_noise_rad = 0.15 * kDegree;
  return r;
}

double rays_per_second(const PatternParameters& p) {
  switch (p.pattern) {
    case Pattern::spinning:
      return double(p.channels) * p.columns * p.rate_hz;
    case Pattern::depth_camera:
      return double(p.width) * p.height * p.rate_hz;
    case Pattern::mid360:
      return 2e5;
    case Pattern::avia:
      return 2.4e5;
  }
  return 0.0;
}

void check_relations(const SensorParameters& s, ParameterFaults& faults) {
  const auto& p = s.pattern;
  const auto& r = s.returns;
  if (r.range_min_m >= r.range_max_m) {
    faults.add(fmt::format("range_min_m is {:g} m and must be below range_max_m, {:g} m",
                           r.range_min_m, r.range_max_m));
  }
  if (p.elevation_lower_rad > p.elevation_upper_rad) {
    faults.add(
        fmt::format("elevation_lower_rad is {:g} and must not be above elevation_upper_rad, "
                    "{:g}",
                    p.elevation_lower_rad, p.elevation_upper_rad));
  }
  if (rays_per_second(p) > kMostRays_1_s) {
    faults.add(
        fmt::format("{:.3g} rays a second are asked for and at most {:.3g} are possible: "
                    "lower rate_hz, the channels or the size of the image",
                    rays_per_second(p), kMostRays_1_s));
  }
}

}  // namespace

void apply_preset(Preset preset, SensorParameters& s) {
  s.preset = preset;
  switch (preset) {
    case Preset::vlp16:
      s.pattern = spinning(16, 1808, 15.0, false);
      s.returns = ranges(0.9, 100.0, 0.03);
      return;
    case Preset::os0_128:
      s.pattern = spinning(128, 1024, 45.0, true);
      s.returns = ranges(0.3, 50.0, 0.015);
      return;
    case Preset::os1_128:
      s.pattern = spinning(128, 1024, 22.5, true);
      s.returns = ranges(0.8, 120.0, 0.03);
      return;
    case Preset::mid360:
      s.pattern = other(Pattern::mid360, 10.0);
      s.returns = mid360_returns();
      return;
    case Preset::avia:
      s.pattern = other(Pattern::avia, 10.0);
      s.returns = ranges(1.0, 190.0, 0.02);
      return;
    case Preset::d435:
      s.pattern = other(Pattern::depth_camera, 30.0);
      s.returns = d435_returns();
      return;
  }
}

Status check(const SensorParameters& parameters) {
  ParameterFaults faults;
  describe(parameters, faults);
  if (faults.empty()) check_relations(parameters, faults);
  return faults.status();
}

}  // namespace goshawk::sensors
