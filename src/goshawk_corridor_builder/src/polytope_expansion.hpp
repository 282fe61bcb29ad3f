#pragma once

#include <vector>

#include "ellipsoid.hpp"
#include "obstacle_boxes.hpp"
#include "separating_plane.hpp"

namespace goshawk::corridor_builder {

/// The thesis' loop: expand the ellipsoid to the nearest obstacle, put a plane there, drop what is
/// behind it, repeat. Obstacles are boxes (with a sphere swept over them) and planes keep them out
/// whole. What a plane leaves of a box is trimmed to the whole voxels that are not all behind it,
/// before the box is looked at.
class PolytopeExpansion {
 public:
  struct Result {
    Separation separation = Separation::roomy;
    Obstacle at = {};  // that leaves too little room, or that the segment enters
  };

  /// @param extent the local box is [0, extent]; its six faces are the first planes, in the order
  ///   -x, +x, -y, +y, -z, +z
  /// @param stop_when_thin gives up at the first obstacle that leaves no room for the balls
  /// @return with planes() the polytope, unless it is blocked, or thin and that is to stop it
  Result expand(const Ellipsoid& ellipsoid, const BoxSet& boxes, const Vec3& extent,
                const Segment& segment, bool stop_when_thin, const Margins& margins);

  const std::vector<Plane>& planes() const { return planes_; }
  void reserve(std::size_t planes) { planes_.reserve(planes); }
  void swap_planes(PolytopeExpansion& other) { planes_.swap(other.planes_); }

 private:
  void add_local_box(const Vec3& extent, const Segment& segment, const Margins& margins);
  void measure(const Ellipsoid& ellipsoid);
  std::size_t nearest(const Ellipsoid& ellipsoid, const Margins& margins);
  bool trim(std::size_t i, const Margins& margins);
  void drop_behind(const Plane& plane, const Margins& margins);
  void remove(std::size_t i);

  std::vector<Plane> planes_;
  BoxSet active_;
  struct Progress {
    Vec3 offset = Vec3::Zero();  // of the nearest point from the ellipsoid's centre, if exact
    bool exact = false;          // else the distance is a lower bound
    std::size_t seen = 0;        // by how many planes the box was trimmed
  };
  std::vector<double> squared_;  // distance of each active box in the ellipsoid's metric
  std::vector<Progress> progress_;
  std::vector<unsigned char> keep_;
};

}  // namespace goshawk::corridor_builder
