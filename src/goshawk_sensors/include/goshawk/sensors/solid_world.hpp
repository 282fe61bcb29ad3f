#pragma once

#include <vector>

#include "goshawk/core/result.hpp"
#include "goshawk/core/vehicle.hpp"
#include "goshawk/sensors/world.hpp"

namespace goshawk::sensors {

/// A convex solid at a pose.
struct Solid {
  enum class Kind { box, cylinder };

  Kind kind = Kind::box;
  Vec3 center = Vec3::Zero();                    // [m] frame of the world
  Quaternion rotation = Quaternion::Identity();  // solid to world
  Vec3 half =
      Vec3::Ones();  // [m] box: half of each side; cylinder: radius, radius, half its height

  static Solid box(const Vec3& lower, const Vec3& upper) {
    return {Kind::box, 0.5 * (lower + upper), Quaternion::Identity(), 0.5 * (upper - lower)};
  }
  /// Upright. @param foot [m] middle of its lower face
  static Solid cylinder(const Vec3& foot, double radius_m, double height_m) {
    return {Kind::cylinder, foot + Vec3(0.0, 0.0, 0.5 * height_m), Quaternion::Identity(),
            Vec3(radius_m, radius_m, 0.5 * height_m)};
  }
};

/// Boxes and cylinders as they are, without voxels. A tree of boxes (median splits) finds the few
/// that a ray may meet.
class SolidWorld : public World {
 public:
  /// @return invalid_input for a solid that is not finite, without extent, or turned by something
  /// that is no rotation
  static Result<SolidWorld> create(std::vector<Solid> solids);

  void cast(std::span<const Ray> rays, std::span<Hit> hits) const override;
  bool contains(const Vec3& point) const override;

  bool empty() const { return parts_.empty(); }

 private:
  struct Part {
    Solid::Kind kind;
    Vec3 center, half;
    Eigen::Matrix<double, 3, 3, Eigen::DontAlign> to_solid;  // rotation
    Vec3 lower, upper;                                       // [m] box around it
  };
  struct Node {
    Vec3 lower, upper;
    int first = 0;  // of its parts, or of its two children
    int parts = 0;  // 0: it has children
  };

  static constexpr int kMaxDepth = 48;

  static Part part_of(const Solid& solid);
  void split(int node, int first, int count);
  Hit cast_one(const Ray& ray) const;
  static Hit cast_at(const Part& part, const Ray& ray);

  std::vector<Part> parts_;  // those of a node stand together
  std::vector<Node> nodes_;  // the root first
};

}  // namespace goshawk::sensors
