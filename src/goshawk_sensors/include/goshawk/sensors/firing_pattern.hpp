#pragma once

#include <cstdint>
#include <vector>

#include "goshawk/core/vector.hpp"
#include "goshawk/sensors/parameters.hpp"

namespace goshawk::sensors {

/// One ray of a scan.
struct Firing {
  Vec3 direction_sensor = Vec3::UnitX();  // of length 1; x forward, y left, z up
  std::int64_t offset_ns = 0;             // from the start of its scan
  std::uint16_t ring = 0;                 // channel, laser or row of the image; the lowest is 0
};

/// Where the rays of each scan go, and when, in the order in which they are fired.
///
/// - spinning: clockwise as seen from above, from behind over the front, as VLP-16 and OS1 turn.
/// - mid360, avia: the formulas of MARSIM (github.com/hku-mars/MARSIM,
///   local_sensing/include/opengl_sim.hpp) as directions, without rounding to pixels or degrees.
///   Time runs on from scan to scan, so no scan repeats another.
/// - depth camera: row by row from the upper left, all pixels at the start of the scan.
class FiringPattern {
 public:
  /// @pre check() of the parameters is ok
  explicit FiringPattern(const PatternParameters& parameters);

  int firings() const { return firings_; }               // in a scan
  std::int64_t period_ns() const { return period_ns_; }  // of scans
  /// How many firings before a firing its neighbour of the same ring is.
  int neighbour() const { return neighbour_; }

  /// @param scan counts from 0 @param i 0 <= i < firings()
  Firing at(std::int64_t scan, int i) const;

 private:
  Firing mid360(std::int64_t scan, int i) const;
  Firing avia(std::int64_t scan, int i) const;
  void fill_spinning();
  void fill_camera();

  PatternParameters parameters_;
  std::int64_t period_ns_;
  int firings_ = 0;
  int neighbour_ = 1;
  std::vector<Firing> table_;  // of the patterns that repeat
};

/// [pixel] A pinhole camera with square pixels, its axis through the middle of the image.
struct Pinhole {
  double focal = 0.0;
  double center_x = 0.0, center_y = 0.0;

  static Pinhole of(const PatternParameters& parameters);
};

}  // namespace goshawk::sensors
