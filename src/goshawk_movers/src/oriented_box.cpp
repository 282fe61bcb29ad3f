#include "goshawk/movers/oriented_box.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace goshawk::movers {

bool OrientedBox::contains(const Vec3& p_map) const {
  return (to_box(p_map).cwiseAbs().array() <= half_m.array()).all();
}

Vec3 OrientedBox::nearest_map(const Vec3& p_map) const {
  const Vec3 p = to_box(p_map);
  const Vec3 nearest = p.cwiseMax(-half_m).cwiseMin(half_m);
  return nearest == p ? p_map : Vec3(center_map + q_map_box * nearest);
}

std::optional<RayHit> OrientedBox::cast(const Vec3& origin_map, const Vec3& direction_map) const {
  const Vec3 o = to_box(origin_map);
  const Vec3 d = q_map_box.conjugate() * direction_map;
  double in = -std::numeric_limits<double>::infinity();
  double out = std::numeric_limits<double>::infinity();
  double cosine = 1.0;
  for (int a = 0; a < 3; ++a) {
    if (d[a] == 0.0) {
      if (std::abs(o[a]) > half_m[a]) return std::nullopt;
      continue;
    }
    const double s = (-half_m[a] - o[a]) / d[a], t = (half_m[a] - o[a]) / d[a];
    if (std::min(s, t) > in) in = std::min(s, t), cosine = std::abs(d[a]);
    out = std::min(out, std::max(s, t));
  }
  if (in > out || out < 0.0) return std::nullopt;
  return in <= 0.0 ? RayHit{} : RayHit{in, cosine};
}

}  // namespace goshawk::movers
