#pragma once

#include "goshawk/core/random.hpp"
#include "goshawk/sensors/parameters.hpp"
#include "goshawk/sensors/solid_world.hpp"

namespace goshawk::sensors {

/// What a sensor sees of its own vehicle, in base_link: a hub of 12 x 12 x 6 cm, four arms of 2 cm
/// in an X, and the discs in which the rotors turn, 3 cm above the arms. The sensor itself is no
/// part of it.
class VehicleBody {
 public:
  /// @pre check() of the parameters is ok
  explicit VehicleBody(const MountParameters& mount);

  bool visible() const { return !frame_.empty(); }

  /// Rays that begin inside of the body do not see it.
  /// @param random whether a rotor's blade is in the way of a ray through its disc
  void cast(std::span<const Ray> rays_base, std::span<Hit> hits, Random& random) const;

 private:
  SolidWorld frame_, rotors_;
  double rotor_share_;
};

}  // namespace goshawk::sensors
