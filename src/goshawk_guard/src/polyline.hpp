#pragma once

#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

#include "goshawk/core/vector.hpp"

namespace goshawk::guard {

/// A path through points, and places on it. @pre two points or more; keeps no copy
class Polyline {
 public:
  explicit Polyline(std::span<const Vec3> points_map) : points_(points_map) {}

  struct Place {
    std::size_t segment = 0;
    double share = 0.0;  // of the segment, [0, 1]
    Vec3 point_map = Vec3::Zero();
    double distance_m = HUGE_VAL;
  };
  /// The first of the places nearest to a point.
  Place nearest(const Vec3& p_map) const {
    Place best;
    for (std::size_t i = 0; i + 1 < points_.size(); ++i) {
      const Vec3 along = points_[i + 1] - points_[i];
      const double squared = along.squaredNorm();
      const double share =
          squared > 0.0 ? std::clamp((p_map - points_[i]).dot(along) / squared, 0.0, 1.0) : 0.0;
      const Vec3 point = points_[i] + share * along;
      const double distance_m = (point - p_map).norm();
      if (distance_m < best.distance_m - kNearer_m) best = {i, share, point, distance_m};
    }
    return best;
  }

  /// What is left of it from so far behind a place on; at least its last point.
  std::vector<Vec3> from(const Place& place, double behind_m) const {
    std::vector<Vec3> left;
    double to_skip_m = behind_m + place.share * length(place.segment);
    for (std::size_t i = place.segment; i + 1 < points_.size(); ++i) {
      if (left.empty() && to_skip_m < length(i)) {
        left.push_back(points_[i] + to_skip_m / length(i) * (points_[i + 1] - points_[i]));
      }
      if (!left.empty()) left.push_back(points_[i + 1]);
      to_skip_m -= length(i);
    }
    if (left.empty()) left.push_back(points_.back());
    return left;
  }

 private:
  static constexpr double kNearer_m = 1e-3;
  double length(std::size_t i) const { return (points_[i + 1] - points_[i]).norm(); }

  std::span<const Vec3> points_;
};

}  // namespace goshawk::guard
