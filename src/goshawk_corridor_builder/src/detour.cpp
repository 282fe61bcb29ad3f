#include "detour.hpp"

#include <algorithm>

#include "chain.hpp"

namespace goshawk::corridor_builder {
namespace {

constexpr int kDeepest = 3;     // halvings of a segment by pushed points
constexpr double kReach = 2.0;  // [voxel edges] how far beside the segment points may be pushed
constexpr double kSpare = 0.1;  // [voxel edges] beyond what is needed, so that planes can turn

Segment hull(const Vec3& p, const Vec3& q, double p_radius, double q_radius) {
  return {p, q, {p_radius, q_radius}, {p_radius, q_radius}};
}

// The point of the segment that is nearest to the obstacle, moved away from it.
Vec3 pushed(const Segment& s, const Obstacle& o) {
  const double t = nearest_parameter(o, s, s.needed);
  const Vec3 x = s.p + t * (s.q - s.p);
  const Vec3 away = x - x.cwiseMax(o.lower).cwiseMin(o.upper);
  const double distance = away.norm();
  if (!(distance > 1e-9)) return x;
  return x + away * ((o.radius + kHalfVoxel + kSpare - distance) / distance);
}

}  // namespace

void Detour::gather(const BoxSet& obstacles, const Vec3& lower, const Vec3& upper) {
  near_.clear();
  for (std::size_t i = 0; i < obstacles.size(); ++i) {
    const double reach = kReach + obstacles.radius[i];
    bool meets = true;
    for (int a = 0; a < 3; ++a) {
      meets &= obstacles.lo[std::size_t(a)][i] < upper[a] + reach &&
               obstacles.hi[std::size_t(a)][i] > lower[a] - reach;
    }
    if (meets) near_.push_back(obstacles.at(i));
  }
}

// The obstacle that reaches farthest into the hull of the segment's balls, or -1.
int Detour::worst_in(const Segment& s) const {
  double least = 0.0;
  int worst = -1;
  for (std::size_t i = 0; i < near_.size(); ++i) {
    if (!meets(near_[i], s, s.needed)) continue;
    const double c = clearance(near_[i], s, s.needed);
    if (c >= least) continue;
    least = c;
    worst = int(i);
  }
  return worst;
}

bool Detour::is_free(const Segment& s) const {
  return std::ranges::none_of(near_, [&](const Obstacle& o) { return meets(o, s, s.needed); });
}

bool Detour::push_away(const BoxSet& obstacles, const Bounds& map, const Segment& segment,
                       std::vector<Vec3>& between) {
  between.clear();
  gather(obstacles, segment.p.cwiseMin(segment.q), segment.p.cwiseMax(segment.q));
  return push(map, segment, 0, between);
}

bool Detour::push(const Bounds& map, const Segment& s, int depth, std::vector<Vec3>& between) {
  const int worst = worst_in(s);
  if (worst < 0) return true;
  if (depth == kDeepest) return false;
  const Vec3 w = pushed(s, near_[std::size_t(worst)]);
  if (((w - map.lower).array() < kHalfVoxel).any()) return false;
  if (((map.upper - w).array() < kHalfVoxel).any()) return false;
  if (!is_free(hull(w, w, kHalfVoxel, kHalfVoxel))) return false;
  if (!push(map, hull(s.p, w, s.needed.p, kHalfVoxel), depth + 1, between)) return false;
  between.push_back(w);
  return push(map, hull(w, s.q, kHalfVoxel, s.needed.q), depth + 1, between);
}

bool Detour::along(const BoxSet& obstacles, const Segment& s, std::span<const Vec3> centres,
                   bool to_last, std::vector<Vec3>& between) {
  between.clear();
  if (centres.empty()) return false;
  gather(obstacles, s.p.cwiseMin(s.q), s.p.cwiseMax(s.q));
  const std::size_t n = centres.size() + (to_last ? 0 : 1);
  auto point = [&](std::size_t i) { return i < centres.size() ? centres[i] : s.q; };
  auto radius = [&](std::size_t i) { return i < centres.size() ? kHalfVoxel : s.needed.q; };
  Vec3 from = s.p;
  double from_radius = s.needed.p;
  for (std::size_t next = 0; next < n;) {
    auto sees = [&](std::size_t i) {
      return is_free(hull(from, point(i), from_radius, radius(i)));
    };
    if (!sees(next)) return false;
    std::size_t far = next;  // seen; then ever farther, and back by halves
    std::size_t step = 1;
    for (; far + step < n && sees(far + step); step *= 2) far += step;
    for (; step > 0; step /= 2) {
      if (far + step < n && sees(far + step)) far += step;
    }
    from = point(far);
    from_radius = radius(far);
    if (far < n - 1 || to_last) between.push_back(from);
    next = far + 1;
  }
  return true;
}

}  // namespace goshawk::corridor_builder
