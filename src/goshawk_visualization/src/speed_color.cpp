#include "goshawk/visualization/speed_color.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace goshawk::visualization {

Vec3 speed_color(double ratio) {
  static const std::array<Vec3, 5> kStops{Vec3(0.18, 0.42, 1.0), Vec3(0.50, 0.34, 0.96),
                                          Vec3(0.82, 0.26, 0.70), Vec3(0.93, 0.28, 0.34),
                                          Vec3(1.0, 0.52, 0.10)};
  const double place = 4.0 * (ratio > 0.0 ? std::min(ratio, 1.0) : 0.0);
  const auto k = std::min<std::size_t>(3, std::size_t(place));
  return kStops[k] + (place - double(k)) * (kStops[k + 1] - kStops[k]);
}

}  // namespace goshawk::visualization
