#include "goshawk/sensors/vehicle_body.hpp"

#include <numbers>

namespace goshawk::sensors {
namespace {

std::vector<Solid> frame_of(const MountParameters& m) {
  if (m.body == Body::none) return {};
  std::vector<Solid> solids{Solid::box(Vec3(-0.06, -0.06, -0.03), Vec3(0.06, 0.06, 0.03))};
  for (int i = 0; i < 2; ++i) {
    Solid arm;
    const double angle = (0.25 + 0.5 * i) * std::numbers::pi;
    arm.rotation = Quaternion(Eigen::AngleAxisd(angle, Vec3::UnitZ()));
    arm.half = Vec3(m.arm_length_m, 0.01, 0.01);
    solids.push_back(arm);
  }
  return solids;
}

std::vector<Solid> rotors_of(const MountParameters& m) {
  if (m.body == Body::none) return {};
  std::vector<Solid> solids;
  const double side_m = m.arm_length_m / std::numbers::sqrt2;
  for (const double x : {-side_m, side_m}) {
    for (const double y : {-side_m, side_m}) {
      solids.push_back(Solid::cylinder(Vec3(x, y, 0.035), m.rotor_radius_m, 0.01));
    }
  }
  return solids;
}

}  // namespace

VehicleBody::VehicleBody(const MountParameters& mount)
    : frame_(SolidWorld::create(frame_of(mount)).value()),
      rotors_(SolidWorld::create(rotors_of(mount)).value()),
      rotor_share_(mount.rotor_share) {}

void VehicleBody::cast(std::span<const Ray> rays_base, std::span<Hit> hits, Random& random) const {
  frame_.cast(rays_base, hits);
  for (std::size_t i = 0; i < rays_base.size(); ++i) {
    if (hits[i].range_m == 0.0) hits[i] = {};
    Hit disc;
    rotors_.cast(rays_base.subspan(i, 1), {&disc, 1});
    const bool nearer = disc.range_m > 0.0 && disc.range_m < hits[i].range_m;
    if (nearer && random.chance(rotor_share_)) hits[i] = disc;
  }
}

}  // namespace goshawk::sensors
