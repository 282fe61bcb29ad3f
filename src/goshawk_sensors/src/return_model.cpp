#include "goshawk/sensors/return_model.hpp"

#include <cmath>

namespace goshawk::sensors {
namespace {

constexpr double kLeastStep_m = 0.02;  // less is no edge but a surface that is seen at an angle

}  // namespace

double ReturnModel::deviation_m(double range_m) const {
  return std::hypot(p_.range_noise_m, p_.range_noise_square_1_m * range_m * range_m);
}

std::optional<double> ReturnModel::measure(double true_m, double beside_m, Random& random) const {
  double range_m = smeared(true_m, beside_m, random);
  if (p_.false_share > 0.0 && random.chance(p_.false_share)) {
    range_m = random.uniform(p_.range_min_m, std::min(range_m, p_.range_max_m));
  }
  if (!(range_m <= p_.range_max_m) || range_m < p_.range_min_m) return std::nullopt;
  if (p_.missing_share > 0.0 && random.chance(p_.missing_share)) return std::nullopt;
  const double deviation = deviation_m(range_m);
  if (deviation > 0.0) range_m += deviation * normal(random);
  // What noise moves out of the range is not reported either.
  if (range_m > p_.range_max_m || range_m < p_.range_min_m) return std::nullopt;
  return range_m;
}

double ReturnModel::smeared(double true_m, double beside_m, Random& random) const {
  const double step_m = std::abs(true_m - beside_m);  // not a number if both see nothing
  const bool edge = step_m > kLeastStep_m && step_m <= p_.edge_depth_m;
  if (!edge || p_.edge_share == 0.0 || !random.chance(p_.edge_share)) return true_m;
  return random.uniform(std::min(true_m, beside_m), std::max(true_m, beside_m));
}

Vec3 ReturnModel::direction(const Vec3& direction, Random& random) const {
  if (p_.angle_noise_rad == 0.0) return direction;
  const Vec3 side = direction.unitOrthogonal();
  const double a = p_.angle_noise_rad * normal(random);
  const double b = p_.angle_noise_rad * normal(random);
  return (direction + a * side + b * direction.cross(side)).normalized();
}

}  // namespace goshawk::sensors
