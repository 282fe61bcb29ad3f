#include "polytope_expansion.hpp"

#include <algorithm>
#include <cmath>

namespace goshawk::corridor_builder {
namespace {

// The first of the least. Four at a time: the comparisons of one chain wait for each other.
std::size_t index_of_least(const std::vector<double>& values) {
  const double* v = values.data();
  const std::size_t n = values.size();
  double least[4] = {v[0], v[0], v[0], v[0]};
  std::size_t i = 0;
  for (; i + 4 <= n; i += 4) {
    for (std::size_t k = 0; k < 4; ++k) least[k] = v[i + k] < least[k] ? v[i + k] : least[k];
  }
  for (; i < n; ++i) least[0] = v[i] < least[0] ? v[i] : least[0];
  const double all = std::min({least[0], least[1], least[2], least[3]});
  return std::size_t(std::find(v, v + n, all) - v);
}

// What a plane leaves of a box, in whole voxels: a layer of the box is cut off if all of it
// is behind. @return false if nothing is left
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

PolytopeExpansion::Result PolytopeExpansion::expand(const Ellipsoid& ellipsoid, const BoxSet& boxes,
                                                    const Vec3& extent, const Segment& segment,
                                                    bool stop_when_thin, const Margins& margins) {
  planes_.clear();
  add_local_box(extent, segment, margins);
  active_ = boxes;
  measure(ellipsoid);
  Result result;
  while (active_.size() > 0) {
    const std::size_t i = nearest(ellipsoid, margins);
    if (i >= active_.size()) break;
    const Obstacle obstacle = active_.at(i);
    Vec3 normal = ellipsoid.metric * progress_[i].offset;
    if (!(normal.norm() > 1e-12)) normal = Vec3::UnitX();
    Plane plane;
    const Separation separation = separate(normal, obstacle, segment, margins, plane);
    if (separation != Separation::roomy && result.separation != Separation::thin) {
      result = {separation, obstacle};
    }
    if (separation == Separation::blocked) return {separation, obstacle};
    if (separation == Separation::thin && stop_when_thin) return result;
    planes_.push_back(plane);
    remove(i);
    drop_behind(plane, margins);
  }
  return result;
}

// The active box that an expanding ellipsoid touches first, trimmed by all planes. Distances are
// computed only of boxes whose lower bound comes up: most are dropped before. @return size() where
// no box is left
std::size_t PolytopeExpansion::nearest(const Ellipsoid& ellipsoid, const Margins& margins) {
  while (active_.size() > 0) {
    const std::size_t i = index_of_least(squared_);
    if (trim(i, margins)) continue;
    Progress& progress = progress_[i];
    if (progress.exact) return i;
    const Nearest at = nearest_in_box(ellipsoid, active_.lower(i), active_.upper(i));
    squared_[i] = at.squared;
    progress.offset = at.offset;
    progress.exact = true;
  }
  return active_.size();
}

void PolytopeExpansion::add_local_box(const Vec3& extent, const Segment& segment,
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

void PolytopeExpansion::measure(const Ellipsoid& ellipsoid) {
  const std::size_t n = active_.size();
  squared_.resize(n);
  progress_.resize(n);
  for (std::size_t i = 0; i < n; ++i) {
    progress_[i].exact = false;
    // Boxes without a sphere are in the local box.
    progress_[i].seen = active_.radius[i] > 0.0 ? 0 : 6;
    squared_[i] = squared_at_least(ellipsoid, active_.lower(i), active_.upper(i));
  }
}

// @return true if box i is not what it was: smaller, or gone
bool PolytopeExpansion::trim(std::size_t i, const Margins& margins) {
  std::size_t& seen = progress_[i].seen;
  if (seen == planes_.size()) return false;
  Vec3 lower = active_.lower(i);
  Vec3 upper = active_.upper(i);
  for (; seen < planes_.size(); ++seen) {
    const Plane& plane = planes_[seen];
    if (!trim_by(plane.normal, margins.behind(plane) + active_.radius[i], lower, upper)) {
      remove(i);
      return true;
    }
  }
  if (lower == active_.lower(i) && upper == active_.upper(i)) return false;
  active_.set(i, lower, upper);
  progress_[i].exact = false;  // the distance of the larger box is a lower bound
  return true;
}

void PolytopeExpansion::drop_behind(const Plane& plane, const Margins& margins) {
  const std::size_t n = active_.size();
  const Vec3& v = plane.normal;
  const double* x = (v[0] > 0 ? active_.lo : active_.hi)[0].data();
  const double* y = (v[1] > 0 ? active_.lo : active_.hi)[1].data();
  const double* z = (v[2] > 0 ? active_.lo : active_.hi)[2].data();
  const double* r = active_.radius.data();
  const double behind = margins.behind(plane);
  keep_.resize(n);
  for (std::size_t i = 0; i < n; ++i) {
    keep_[i] = v[0] * x[i] + v[1] * y[i] + v[2] * z[i] - r[i] < behind;
  }
  std::size_t kept = 0;
  for (std::size_t i = 0; i < n; ++i) {
    if (!keep_[i]) continue;
    if (kept != i) {
      active_.copy(i, kept);
      squared_[kept] = squared_[i];
      progress_[kept] = progress_[i];
    }
    ++kept;
  }
  active_.resize(kept);
  squared_.resize(kept);
  progress_.resize(kept);
}

void PolytopeExpansion::remove(std::size_t i) {
  const std::size_t last = active_.size() - 1;
  active_.copy(last, i);
  squared_[i] = squared_[last];
  progress_[i] = progress_[last];
  active_.resize(last);
  squared_.resize(last);
  progress_.resize(last);
}

}  // namespace goshawk::corridor_builder
