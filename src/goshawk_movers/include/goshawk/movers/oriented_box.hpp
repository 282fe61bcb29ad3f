#pragma once

#include <optional>

#include "goshawk/core/vehicle.hpp"

namespace goshawk::movers {

struct RayHit {
  double range_m = 0.0;  // along the ray; 0 if it begins inside
  double cosine = 1.0;   // of the angle between the ray and the face's normal, 0 to 1
};

/// A box at a pose.
struct OrientedBox {
  Vec3 center_map = Vec3::Zero();                 // [m]
  Quaternion q_map_box = Quaternion::Identity();  // box to map
  Vec3 half_m = Vec3::Ones();                     // half of each edge

  /// [m] p in the box's own frame
  Vec3 to_box(const Vec3& p_map) const { return q_map_box.conjugate() * Vec3(p_map - center_map); }
  bool contains(const Vec3& p_map) const;
  /// [m] the point of the box that is nearest; p itself if it lies inside
  Vec3 nearest_map(const Vec3& p_map) const;
  /// [m] 0 inside
  double distance_m(const Vec3& p_map) const { return (nearest_map(p_map) - p_map).norm(); }

  /// The first point of a ray within the box, exactly.
  /// @param direction_map of length 1 @return nothing if there is none
  std::optional<RayHit> cast(const Vec3& origin_map, const Vec3& direction_map) const;
};

}  // namespace goshawk::movers
