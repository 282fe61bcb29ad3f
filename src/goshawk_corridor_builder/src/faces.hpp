#pragma once

#include <algorithm>
#include <limits>
#include <vector>

#include "goshawk/core/polytope.hpp"

namespace goshawk::corridor_builder {

/// A polytope in frame map whose memory is kept when it changes: what is built here is one of
/// these, and becomes a goshawk::Polytope only in the answer.
struct Faces {
  std::vector<double> normals;  // three a face
  std::vector<double> offsets;  // [m]

  int size() const { return int(offsets.size()); }
  void reserve(std::size_t faces) {
    normals.reserve(3 * faces);
    offsets.reserve(faces);
  }
  void clear() {
    normals.clear();
    offsets.clear();
  }
  void add(const Vec3& n, double offset_m) {
    normals.insert(normals.end(), {n[0], n[1], n[2]});
    offsets.push_back(offset_m);
  }
  double slack(std::size_t i, const Vec3& p_map) const {
    const double* n = normals.data() + 3 * i;
    return offsets[i] - (n[0] * p_map[0] + n[1] * p_map[1] + n[2] * p_map[2]);
  }
  /// @return [m] distance to the nearest face, negative outside
  double room(const Vec3& p_map) const {
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < offsets.size(); ++i) least = std::min(least, slack(i, p_map));
    return least;
  }
  HalfSpaces view() const { return {normals.data(), offsets.data(), size()}; }
};

inline Ball largest_ball(const Faces& a) {
  const HalfSpaces parts[] = {a.view()};
  return chebyshev_ball(parts);
}
inline Ball largest_ball(const Faces& a, const Faces& b) {
  const HalfSpaces parts[] = {a.view(), b.view()};
  return chebyshev_ball(parts);
}

}  // namespace goshawk::corridor_builder
