#include "goshawk/simulator/force_limits.hpp"

#include <algorithm>
#include <cmath>

namespace goshawk::simulator {
namespace {

constexpr double kThrustShare = 0.9;       // of the maximum; the rest is for attitude control
constexpr double kLeastWeightShare = 0.3;  // of the weight, so that the attitude means something

}  // namespace

Vec3 limited_force(const plant::VehicleParameters& parameters, double max_tilt_rad,
                   const Vec3& acceleration_map) {
  const double weight_n = parameters.weight_n();
  const double most_n = std::max(weight_n, kThrustShare * parameters.max_thrust_n());
  Vec3 force = parameters.mass_kg * (acceleration_map + Vec3(0.0, 0.0, kGravity_m_s2));
  force.z() = std::clamp(force.z(), kLeastWeightShare * weight_n, most_n);
  const double side = force.head<2>().norm();
  const double side_max = std::min(force.z() * std::tan(max_tilt_rad),
                                   std::sqrt(most_n * most_n - force.z() * force.z()));
  if (side > side_max) force.head<2>() *= side_max / side;
  return force;
}

}  // namespace goshawk::simulator
