#pragma once

#include "goshawk/core/words.hpp"

namespace goshawk::sensors {

/// Where the rays of a sensor go.
enum class Pattern {
  spinning,      // rows of lasers that turn about the sensor's z axis
  mid360,        // a non-repeating pattern around it
  avia,          // a non-repeating pattern in front of it
  depth_camera,  // a pinhole camera: all pixels at one moment
};

constexpr auto words_of(Pattern) {
  using enum Pattern;
  return std::to_array<Named<Pattern>>(
      {{spinning, "spinning"}, {mid360, "mid360"}, {avia, "avia"}, {depth_camera, "depth_camera"}});
}

/// Models whose numbers are known (docs/sensing.md has the sources).
enum class Preset { vlp16, os0_128, os1_128, mid360, avia, d435 };

constexpr auto words_of(Preset) {
  using enum Preset;
  return std::to_array<Named<Preset>>({{vlp16, "vlp16"},
                                       {os0_128, "os0_128"},
                                       {os1_128, "os1_128"},
                                       {mid360, "mid360"},
                                       {avia, "avia"},
                                       {d435, "d435"}});
}

/// What a sensor sees of the vehicle that carries it.
enum class Body {
  none,
  quadrotor,  // a hub, four arms and four rotors
};

constexpr auto words_of(Body) {
  using enum Body;
  return std::to_array<Named<Body>>({{none, "none"}, {quadrotor, "quadrotor"}});
}

}  // namespace goshawk::sensors
