#include "redundancy.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace goshawk::corridor_builder {
namespace {

constexpr double kOnPlane = 1e-9;  // [voxel edges] a vertex this near to a plane lies on it

// Is n . x <= d implied, up to the tolerance, for |x| <= far by the three planes?
bool implied_by(const Plane& plane, const Plane& a, const Plane& b, const Plane& c, double far,
                double tolerance) {
  Eigen::Matrix3d normals;
  normals << a.normal, b.normal, c.normal;
  if (!(std::abs(normals.determinant()) > 1e-9)) return false;
  const Vec3 weights = (normals.inverse() * plane.normal).cwiseMax(0.0);
  const Vec3 rest = plane.normal - normals * weights;
  const double bound = weights.dot(Vec3(a.offset, b.offset, c.offset)) + rest.norm() * far;
  return bound <= plane.offset + tolerance;
}

// Two vertices are joined by an edge if they share two planes.
template <typename Mask>
bool has_two(const Mask& mask) {
  unsigned bits = 0;
  for (const std::uint64_t word : mask) {
    if (word == 0) continue;
    bits += (word & (word - 1)) != 0 ? 2 : 1;
  }
  return bits >= 2;
}

}  // namespace

void RedundancyFilter::filter(std::span<const Plane> planes, const Vec3& extent,
                              const Margins& margins, std::vector<Plane>& kept) {
  const std::size_t count = std::min(planes.size(), std::size_t(kMostPlanes));
  start(planes);
  for (std::size_t k = 6; k < count; ++k) clip(planes[k], k);
  face_.assign(planes.size(), 1);
  for (std::size_t k = 0; k < count; ++k) {
    const auto touching = std::count_if(vertices_.begin(), vertices_.end(),
                                        [&](const Vertex& v) { return v.lies_on(k); });
    face_[k] = planes[k].tight || touching >= 3;
  }
  const double far = 2.0 * extent.norm() + 1.0;
  for (std::size_t k = 0; k < count; ++k) {
    if (!face_[k] && !follows_from_kept(planes, k, far, 0.25 * margins.plane)) face_[k] = 1;
  }
  kept.clear();
  for (std::size_t k = 0; k < planes.size(); ++k) {
    if (face_[k]) kept.push_back(planes[k]);
  }
}

void RedundancyFilter::start(std::span<const Plane> planes) {
  vertices_.clear();
  for (unsigned corner = 0; corner < 8; ++corner) {
    Vertex v;
    for (unsigned axis = 0; axis < 3; ++axis) {
      const unsigned side = (corner >> axis) & 1U;
      const std::size_t k = 2 * axis + side;
      v.x[axis] = side ? planes[k].offset : -planes[k].offset;
      v.put_on(k);
    }
    vertices_.push_back(v);
  }
}

void RedundancyFilter::clip(const Plane& plane, std::size_t index) {
  next_.clear();
  bool cuts = false;
  for (Vertex& v : vertices_) {
    v.height = -plane.slack(v.x);
    if (std::abs(v.height) <= kOnPlane) v.put_on(index);
    cuts |= v.height > kOnPlane;
    if (v.height <= kOnPlane) next_.push_back(v);
  }
  if (!cuts) return;
  for (const Vertex& in : vertices_) {
    if (in.height >= -kOnPlane) continue;
    for (const Vertex& out : vertices_) {
      if (out.height <= kOnPlane) continue;
      const Mask edge{in.on[0] & out.on[0], in.on[1] & out.on[1]};
      if (!has_two(edge)) continue;
      Vertex v;
      const double t = in.height / (in.height - out.height);
      v.x = in.x + t * (out.x - in.x);
      v.on = edge;
      v.put_on(index);
      next_.push_back(v);
    }
  }
  std::swap(vertices_, next_);
}

// The planes at the vertex that lies farthest along the normal are the ones to try.
bool RedundancyFilter::follows_from_kept(std::span<const Plane> planes, std::size_t k, double far,
                                         double tolerance) const {
  const auto farthest =
      std::min_element(vertices_.begin(), vertices_.end(), [&](const Vertex& a, const Vertex& b) {
        return planes[k].slack(a.x) < planes[k].slack(b.x);
      });
  if (farthest == vertices_.end()) return false;
  std::size_t at[6];
  std::size_t n = 0;
  for (std::size_t i = 0; i < face_.size() && i < kMostPlanes && n < 6; ++i) {
    if (farthest->lies_on(i) && face_[i] && i != k) at[n++] = i;
  }
  for (std::size_t a = 0; a < n; ++a) {
    for (std::size_t b = a + 1; b < n; ++b) {
      for (std::size_t c = b + 1; c < n; ++c) {
        if (implied_by(planes[k], planes[at[a]], planes[at[b]], planes[at[c]], far, tolerance)) {
          return true;
        }
      }
    }
  }
  return false;
}

}  // namespace goshawk::corridor_builder
