#pragma once

#include <optional>
#include <vector>

#include "ellipsoid.hpp"
#include "obstacle_boxes.hpp"
#include "separating_plane.hpp"

namespace goshawk::corridor_builder {

/// The thesis' loop: expand the ellipsoid to the nearest obstacle, put a plane there, drop what is
/// behind it, repeat. Obstacles are boxes and planes keep whole boxes out. What a plane leaves of
/// a box is trimmed to the whole voxels that are not all behind it, before the box is looked at.
class PolytopeInflation {
 public:
  struct Blocked {
    Vec3 lower, upper;  // the box that the segment enters
  };

  /// @param extent the local box is [0, extent]; its six faces are the first planes, in the order
  ///   -x, +x, -y, +y, -z, +z
  /// @param wanted_slack [voxel edges] that planes should keep from both ends of the segment
  /// @return nothing, with planes() the polytope, or the box that cannot be kept out
  std::optional<Blocked> inflate(const Ellipsoid& ellipsoid, const BoxSet& boxes,
                                 const Vec3& extent, const Segment& segment, double wanted_slack,
                                 const Margins& margins);

  const std::vector<Plane>& planes() const { return planes_; }

 private:
  void add_local_box(const Vec3& extent, const Segment& segment, const Margins& margins);
  void measure(const Ellipsoid& ellipsoid);
  bool trim(std::size_t i, const Ellipsoid& ellipsoid, const Margins& margins);
  void drop_behind(const Plane& plane, const Margins& margins);
  void remove(std::size_t i);

  std::vector<Plane> planes_;
  BoxSet active_;
  std::vector<double> squared_;    // distance of each active box in the ellipsoid's metric
  std::vector<std::size_t> seen_;  // how many planes each active box was trimmed by
  std::vector<unsigned char> keep_;
};

}  // namespace goshawk::corridor_builder
