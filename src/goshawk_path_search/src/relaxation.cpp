#include "goshawk/path_search/relaxation.hpp"

#include <algorithm>
#include <cmath>

#include "goshawk/core/line_of_sight.hpp"

namespace goshawk::path_search {
namespace {

constexpr int kMostSweeps = 12;
constexpr int kHalvings = 7;              // a point stops within 1/128 of the way that is free
constexpr double kLeastGain = 1e-4;       // [voxels] less is not worth a move
constexpr double kWorkPerPoint = 2000.0;  // [voxels] of line of sight

class Puller {
 public:
  Puller(const BitGrid& blocked, std::vector<Vec3>& points)
      : blocked_(blocked), points_(points), work_left_(kWorkPerPoint * double(points.size())) {}

  int run() {
    int changes = 0;
    for (int sweep = 0; sweep < kMostSweeps && work_left_ > 0.0; ++sweep) {
      const int before = changes;
      for (std::size_t i = 1; i + 1 < points_.size() && work_left_ > 0.0;) {
        if (is_free(points_[i - 1], points_[i + 1])) {
          points_.erase(points_.begin() + std::ptrdiff_t(i));
          ++changes;
          continue;
        }
        changes += pull(i);
        ++i;
      }
      if (changes == before) break;
    }
    return changes;
  }

 private:
  bool is_free(const Vec3& a, const Vec3& b) {
    work_left_ -= (b - a).lpNorm<1>() + 1.0;
    return line_is_free(blocked_, a, b);
  }

  // Towards the nearest point of the chord, and along either leg.
  bool pull(std::size_t i) {
    const Vec3 a = points_[i - 1], b = points_[i + 1];
    const double along = (points_[i] - a).dot(b - a) / std::max((b - a).squaredNorm(), 1e-300);
    const Vec3 foot = a + std::clamp(along, 0.0, 1.0) * (b - a);
    bool moved = false;
    for (const Vec3& target : {foot, a, b}) {
      const Vec3 p = points_[i];
      const Vec3 q = farthest_free(a, p, b, target);
      if ((q - a).norm() + (b - q).norm() > (p - a).norm() + (b - p).norm() - kLeastGain) continue;
      points_[i] = q;
      moved = true;
    }
    return moved;
  }

  // A point between p and the target, as far along as halving finds both of its legs free.
  Vec3 farthest_free(const Vec3& a, const Vec3& p, const Vec3& b, const Vec3& target) {
    double good = 0.0, bad = 1.0;
    for (int k = 0; k < kHalvings; ++k) {
      const double middle = (good + bad) / 2.0;
      const Vec3 q = p + middle * (target - p);
      (is_free(a, q) && is_free(q, b) ? good : bad) = middle;
    }
    return p + good * (target - p);
  }

  const BitGrid& blocked_;
  std::vector<Vec3>& points_;
  double work_left_;
};

}  // namespace

int pull_tight(const BitGrid& blocked, std::vector<Vec3>& points) {
  return Puller(blocked, points).run();
}

}  // namespace goshawk::path_search
