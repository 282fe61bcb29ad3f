#pragma once

#include <concepts>
#include <cstdint>
#include <numbers>
#include <type_traits>

#include "goshawk/core/parameter.hpp"
#include "goshawk/sensors/words.hpp"

namespace goshawk::sensors {

inline constexpr double kDegree = std::numbers::pi / 180.0;  // [rad]

/// Where rays go, and when.
struct PatternParameters {
  Pattern pattern = Pattern::spinning;
  double rate_hz = 10.0;  // scans or images
  int channels = 16;      // spinning: rows of lasers
  int columns = 1808;     // spinning: firings of all channels within azimuth_width_rad
  double elevation_lower_rad = -0.261799;             // spinning: of the lowest channel
  double elevation_upper_rad = 0.261799;              // spinning: of the highest channel
  double azimuth_width_rad = 2.0 * std::numbers::pi;  // spinning: centred on the sensor's x axis
  bool channels_together = false;  // spinning: all channels of a column fire at once, else in turn
  int width = 212;                 // depth camera: pixels
  int height = 120;                // depth camera: pixels
  double horizontal_view_rad = 1.518436;  // depth camera: full angle over the width
};

/// What is wrong with what a sensor measures. A depth camera measures depth along its axis, not
/// range: there the lengths are depths.
struct ReturnParameters {
  double range_min_m = 0.9;             // nearer surfaces give no return
  double range_max_m = 100.0;           // farther ones give none
  double range_noise_m = 0.03;          // standard deviation, and
  double range_noise_square_1_m = 0.0;  // times the range squared, both added in quadrature
  double angle_noise_rad = 0.0;         // standard deviation across the ray, on both axes
  double missing_share = 0.0;           // of the returns
  double false_share = 0.0;             // of the rays: rain, dust; anywhere before the surface
  double edge_share = 0.0;      // of the rays beside an edge: anywhere between both surfaces
  double edge_depth_m = 1.0;    // longest step between two surfaces that still smears
  double reflectivity = 100.0;  // intensity of a surface that is hit at right angles
};

/// Where the sensor sits on the vehicle, and what of the vehicle it sees.
struct MountParameters {
  double x_m = 0.0;
  double y_m = 0.0;
  double z_m = 0.1;
  double roll_rad = 0.0;
  double pitch_rad = 0.0;
  double yaw_rad = 0.0;
  Body body = Body::none;
  double arm_length_m = 0.17;  // centre to each rotor's axis
  double rotor_radius_m = 0.08;
  double rotor_share = 0.1;  // of the rays through a rotor's disc that its blades return
};

struct SensorParameters {
  Preset preset = Preset::vlp16;
  PatternParameters pattern;
  ReturnParameters returns;
  MountParameters mount;
  double latency_s = 0.0;   // from the end of a scan to its publication
  double drop_share = 0.0;  // of the scans, not published
  int seed = 1;
};

/// Sets what a preset says: pattern, ranges and noise. Mount, latency, drops and seed stay.
void apply_preset(Preset preset, SensorParameters& parameters);

/// @return invalid_parameter with every fault: values out of range, ranges and angles that are not
/// in order, more than 20 million rays a second
Status check(const SensorParameters& parameters);

template <typename Self, typename Visitor>
requires std::same_as<std::remove_const_t<Self>, PatternParameters>
void describe(Self& p, Visitor&& visit) {
  constexpr double pi = std::numbers::pi;
  visit("pattern", p.pattern, "",
        "where rays go: spinning (rows of lasers), mid360 and avia (non-repeating), depth_camera",
        Anything{});
  visit("rate_hz", p.rate_hz, "Hz", "scans or images a second", Range{1.0, 1000.0});
  visit("channels", p.channels, "", "spinning: rows of lasers", Range{1.0, 1024.0});
  visit("columns", p.columns, "", "spinning: firings of all channels in a scan",
        Range{1.0, 65536.0});
  visit("elevation_lower_rad", p.elevation_lower_rad, "rad", "spinning: of the lowest channel",
        Range{-0.5 * pi, 0.5 * pi});
  visit("elevation_upper_rad", p.elevation_upper_rad, "rad", "spinning: of the highest channel",
        Range{-0.5 * pi, 0.5 * pi});
  visit("azimuth_width_rad", p.azimuth_width_rad, "rad",
        "spinning: horizontal field of view, centred on the sensor's x axis",
        Range::positive(6.2832));
  visit("channels_together", p.channels_together, "",
        "spinning: all channels of a column fire at once; else one after another", Anything{});
  visit("width", p.width, "", "depth camera: pixels in a row", Range{1.0, 4096.0});
  visit("height", p.height, "", "depth camera: pixels in a column", Range{1.0, 4096.0});
  visit("horizontal_view_rad", p.horizontal_view_rad, "rad",
        "depth camera: full angle over the width; pixels are square", Range{0.01, 3.0});
}

template <typename Self, typename Visitor>
requires std::same_as<std::remove_const_t<Self>, ReturnParameters>
void describe(Self& r, Visitor&& visit) {
  const Range share{0.0, 1.0};
  visit("range_min_m", r.range_min_m, "m", "surfaces that are nearer give no return",
        Range{0.0, 1000.0});
  visit("range_max_m", r.range_max_m, "m", "surfaces that are farther give no return",
        Range::positive(1000.0));
  visit("range_noise_m", r.range_noise_m, "m",
        "standard deviation of the range, or of a depth camera's depth", Range{0.0, 10.0});
  visit("range_noise_square_1_m", r.range_noise_square_1_m, "1/m",
        "stereo: this times the squared depth is a second deviation, added in quadrature",
        Range{0.0, 10.0});
  visit("angle_noise_rad", r.angle_noise_rad, "rad",
        "standard deviation of a return's direction, on both axes across the ray", Range{0.0, 0.1});
  visit("missing_share", r.missing_share, "", "share of the returns that are lost", share);
  visit("false_share", r.false_share, "",
        "share of the rays that return from rain or dust, anywhere before the surface", share);
  visit("edge_share", r.edge_share, "",
        "share of the rays beside an edge that return from between both surfaces", share);
  visit("edge_depth_m", r.edge_depth_m, "m", "longest step between two surfaces that smears",
        Range{0.0, 1000.0});
  visit("reflectivity", r.reflectivity, "", "intensity of a surface that is hit at right angles",
        Range{0.0, 255.0});
}

template <typename Self, typename Visitor>
requires std::same_as<std::remove_const_t<Self>, MountParameters>
void describe(Self& m, Visitor&& visit) {
  const Range angle{-3.1416, 3.1416};
  const Range place{-10.0, 10.0};
  visit("mount_x_m", m.x_m, "m", "where the sensor sits in base_link", place);
  visit("mount_y_m", m.y_m, "m", "the same for y", place);
  visit("mount_z_m", m.z_m, "m", "the same for z", place);
  visit("mount_roll_rad", m.roll_rad, "rad", "how it is turned: about x first", angle);
  visit("mount_pitch_rad", m.pitch_rad, "rad", "then about base_link's y; positive looks down",
        angle);
  visit("mount_yaw_rad", m.yaw_rad, "rad", "then about base_link's z", angle);
  visit("body", m.body, "", "what the sensor sees of the vehicle: none or quadrotor", Anything{});
  visit("body_arm_length_m", m.arm_length_m, "m", "centre of the vehicle to each rotor's axis",
        Range::positive(10.0));
  visit("body_rotor_radius_m", m.rotor_radius_m, "m", "radius of a rotor", Range::positive(10.0));
  visit("body_rotor_share", m.rotor_share, "",
        "share of the rays through a rotor's disc that its blades return", Range{0.0, 1.0});
}

template <typename Self, typename Visitor>
requires std::same_as<std::remove_const_t<Self>, SensorParameters>
void describe(Self& s, Visitor&& visit) {
  [[maybe_unused]] const Preset before = s.preset;
  visit("preset", s.preset, "",
        "sets pattern, ranges and noise as this model has them; what is given beside it prevails",
        Anything{});
  // A visitor that writes has set the preset; the parameters below see its values.
  if constexpr (!std::is_const_v<Self>) {
    if (s.preset != before) apply_preset(s.preset, s);
  }
  describe(s.pattern, visit);
  describe(s.returns, visit);
  describe(s.mount, visit);
  visit("latency_s", s.latency_s, "s", "from the end of a scan to its publication",
        Range{0.0, 1.0});
  visit("drop_share", s.drop_share, "", "share of the scans that are not published",
        Range{0.0, 1.0});
  visit("seed", s.seed, "", "seed of noise, losses and drops: the same seed gives the same bytes",
        Range{0.0, 2147483647.0});
}

}  // namespace goshawk::sensors
