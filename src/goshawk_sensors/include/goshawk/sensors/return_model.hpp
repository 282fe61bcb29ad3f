#pragma once

#include <optional>

#include "goshawk/core/random.hpp"
#include "goshawk/sensors/parameters.hpp"
#include "goshawk/sensors/world.hpp"

namespace goshawk::sensors {

/// Sum of twelve uniform numbers: close to normal, bounded by six deviations, and made of additions
/// only, so that every machine draws the same. Each of three draws gives four of the numbers.
inline double normal(Random& random) {
  std::uint64_t sum = 0;
  for (int i = 0; i < 3; ++i) {
    for (std::uint64_t bits = random.next(), k = 0; k < 4; ++k, bits >>= 16) sum += bits & 0xFFFFU;
  }
  return (double(sum) + 6.0) * 0x1.0p-16 - 6.0;  // + 6: numbers lie in the middle of their steps
}

/// What a sensor makes of the distance to a surface.
class ReturnModel {
 public:
  /// @pre check() of the parameters is ok
  explicit ReturnModel(const ReturnParameters& parameters) : p_(parameters) {}

  /// Lengths are ranges, or a depth camera's depths.
  /// @param true_m to the surface; infinite: there is none
  /// @param beside_m the same of the neighbouring ray
  /// @return what is measured; nothing for a missing return: no surface, nearer or farther than
  /// the sensor measures, or lost
  std::optional<double> measure(double true_m, double beside_m, Random& random) const;

  /// [m] standard deviation of the noise at a range
  double deviation_m(double range_m) const;

  /// The direction in which a return is reported. @param direction of length 1
  Vec3 direction(const Vec3& direction, Random& random) const;

 private:
  double smeared(double true_m, double beside_m, Random& random) const;

  ReturnParameters p_;
};

}  // namespace goshawk::sensors
