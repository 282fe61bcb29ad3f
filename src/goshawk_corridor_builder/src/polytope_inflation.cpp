#include "polytope_inflation.hpp"

#include <algorithm>
#include <cmath>

namespace goshawk::corridor_builder {
namespace {

// What a plane leaves of a box, in whole voxels: a layer of the box is cut off where all of it
// is behind. @return false where nothing is left
bool trim_by(const Vec3& n, double behind, Vec3& lower, Vec3& upper) {
  const double reach = behind - support(n, lower, upper);
  if (reach <= 0.0) return false;
  for (int a = 0; a < 3; ++a) {
    if (std::abs(n[a]) < 1e-9) continue;
    const double layers = reach / std::abs(n[a]);
    if (n[a] > 0.0) {
      upper[a] = std::min(upper[a], std::ceil(lower[a] + layers));
    } else {
      lower[a] = std::max(lower[a], std::floor(upper[a] - layers));
    }
  }
  return true;
}

}  // namespace

std::optional<PolytopeInflation::Blocked> PolytopeInflation::inflate(
    const Ellipsoid& ellipsoid, const BoxSet& boxes, const Vec3& extent, const Segment& segment,
    double wanted_slack, const Margins& margins) {
  planes_.clear();
  add_local_box(extent, segment, margins);
  active_ = boxes;
  measure(ellipsoid);
  while (active_.size() > 0) {
    const auto nearest = std::min_element(squared_.begin(), squared_.end());
    const std::size_t i = std::size_t(nearest - squared_.begin());
    if (trim(i, ellipsoid, margins)) continue;
    const Vec3 lower = active_.lower(i);
    const Vec3 upper = active_.upper(i);
    const Vec3 offset = nearest_in_box(ellipsoid, lower, upper).offset;
    Vec3 normal = ellipsoid.metric * offset;
    if (!(normal.norm() > 1e-12)) normal = Vec3::UnitX();
    Plane plane;
    if (!separate(normal, lower, upper, segment, wanted_slack, margins, plane)) {
      return Blocked{lower, upper};
    }
    planes_.push_back(plane);
    remove(i);
    drop_behind(plane, margins);
  }
  return std::nullopt;
}

void PolytopeInflation::add_local_box(const Vec3& extent, const Segment& segment,
                                      const Margins& margins) {
  for (int axis = 0; axis < 3; ++axis) {
    for (const double side : {-1.0, 1.0}) {
      Plane plane;
      plane.normal = side * Vec3::Unit(axis);
      plane.offset = side < 0.0 ? 0.0 : extent[axis];
      const double room = std::min(plane.slack(segment.p), plane.slack(segment.q));
      plane.tight = room < 2.0 * margins.plane;
      plane.offset -= plane.tight ? 2.0 * margins.rounding : margins.plane;
      planes_.push_back(plane);
    }
  }
}

void PolytopeInflation::measure(const Ellipsoid& ellipsoid) {
  squared_.resize(active_.size());
  seen_.assign(active_.size(), 6);  // boxes lie within the local box
  for (std::size_t i = 0; i < active_.size(); ++i) {
    squared_[i] = nearest_in_box(ellipsoid, active_.lower(i), active_.upper(i)).squared;
  }
}

// @return true where box i is not what it was: smaller, or gone
bool PolytopeInflation::trim(std::size_t i, const Ellipsoid& ellipsoid, const Margins& margins) {
  if (seen_[i] == planes_.size()) return false;
  Vec3 lower = active_.lower(i);
  Vec3 upper = active_.upper(i);
  for (; seen_[i] < planes_.size(); ++seen_[i]) {
    const Plane& plane = planes_[seen_[i]];
    if (!trim_by(plane.normal, margins.behind(plane), lower, upper)) {
      remove(i);
      return true;
    }
  }
  if (lower == active_.lower(i) && upper == active_.upper(i)) return false;
  active_.set(i, lower, upper);
  squared_[i] = nearest_in_box(ellipsoid, lower, upper).squared;
  return true;
}

void PolytopeInflation::drop_behind(const Plane& plane, const Margins& margins) {
  const std::size_t n = active_.size();
  const Vec3& v = plane.normal;
  const double* x = (v[0] > 0 ? active_.lo : active_.hi)[0].data();
  const double* y = (v[1] > 0 ? active_.lo : active_.hi)[1].data();
  const double* z = (v[2] > 0 ? active_.lo : active_.hi)[2].data();
  const double behind = margins.behind(plane);
  keep_.resize(n);
  for (std::size_t i = 0; i < n; ++i) {
    keep_[i] = v[0] * x[i] + v[1] * y[i] + v[2] * z[i] < behind;
  }
  std::size_t kept = 0;
  for (std::size_t i = 0; i < n; ++i) {
    if (!keep_[i]) continue;
    if (kept != i) {
      active_.copy(i, kept);
      squared_[kept] = squared_[i];
      seen_[kept] = seen_[i];
    }
    ++kept;
  }
  active_.resize(kept);
  squared_.resize(kept);
  seen_.resize(kept);
}

void PolytopeInflation::remove(std::size_t i) {
  const std::size_t last = active_.size() - 1;
  active_.copy(last, i);
  squared_[i] = squared_[last];
  seen_[i] = seen_[last];
  active_.resize(last);
  squared_.resize(last);
  seen_.resize(last);
}

}  // namespace goshawk::corridor_builder
