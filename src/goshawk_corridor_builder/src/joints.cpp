#include "joints.hpp"

#include <algorithm>

namespace goshawk::corridor_builder {
namespace {

constexpr double kHalfVoxel = 0.499;  // less what planes keep away from obstacles
constexpr double kNearlyAsGood = 0.7;

// How far from `from` (0) to `center` (1) a point has at least `clearance` to every face: slacks
// are linear along the way.
double needed_step(const Polytope& polytope, const Vec3& from, const Vec3& center,
                   double clearance) {
  double step = 0.0;
  for (int i = 0; i < polytope.faces(); ++i) {
    const double here = polytope.b[i] - polytope.A.row(i).dot(from);
    if (here >= clearance) continue;
    const double there = polytope.b[i] - polytope.A.row(i).dot(center);
    step = std::max(step, there > clearance ? (clearance - here) / (there - here) : 1.0);
  }
  return std::min(step, 1.0);
}

void erase_polytope(std::size_t k, Chain& chain) {
  chain.polytopes.erase(chain.polytopes.begin() + std::ptrdiff_t(k));
}

void drop_ends(double spare_m, Chain& chain, std::vector<Ball>& overlaps) {
  auto holds = [&](const Polytope& polytope, const Vec3& p) {
    return polytope.violation(p) <= -spare_m;
  };
  while (chain.polytopes.size() > 1 && holds(chain.polytopes[1], chain.joints_map.front())) {
    erase_polytope(0, chain);
    chain.joints_map.erase(chain.joints_map.begin() + 1);
    overlaps.erase(overlaps.begin());
  }
  while (chain.polytopes.size() > 1 &&
         holds(chain.polytopes[chain.polytopes.size() - 2], chain.joints_map.back())) {
    chain.polytopes.pop_back();
    chain.joints_map.erase(chain.joints_map.end() - 2);
    overlaps.pop_back();
  }
}

}  // namespace

void measure_overlaps(const std::vector<Polytope>& polytopes, std::vector<Ball>& overlaps) {
  overlaps.clear();
  for (std::size_t k = 0; k + 1 < polytopes.size(); ++k) {
    overlaps.push_back(chebyshev_ball(polytopes[k], polytopes[k + 1]));
  }
}

void drop_covered(double resolution_m, Chain& chain, std::vector<Ball>& overlaps) {
  const double half_voxel_m = kHalfVoxel * resolution_m;
  drop_ends(half_voxel_m, chain, overlaps);
  for (std::size_t k = 1; k + 1 < chain.polytopes.size();) {
    const Ball shortcut = chebyshev_ball(chain.polytopes[k - 1], chain.polytopes[k + 1]);
    const double before = std::min(overlaps[k - 1].radius_m, overlaps[k].radius_m);
    if (shortcut.radius_m < std::max(half_voxel_m, kNearlyAsGood * before)) {
      ++k;
      continue;
    }
    chain.joints_map[k] = 0.5 * (chain.joints_map[k] + chain.joints_map[k + 1]);
    chain.joints_map.erase(chain.joints_map.begin() + std::ptrdiff_t(k) + 1);
    erase_polytope(k, chain);
    overlaps[k - 1] = shortcut;
    overlaps.erase(overlaps.begin() + std::ptrdiff_t(k));
  }
}

void settle_joints(double clearance_m, const std::vector<Ball>& overlaps, Chain& chain) {
  for (std::size_t k = 0; k < overlaps.size(); ++k) {
    const Ball& ball = overlaps[k];
    const double clearance = std::min(clearance_m, ball.radius_m);
    Vec3& joint = chain.joints_map[k + 1];
    const double step =
        std::max(needed_step(chain.polytopes[k], joint, ball.center_map, clearance),
                 needed_step(chain.polytopes[k + 1], joint, ball.center_map, clearance));
    joint += step * (ball.center_map - joint);
  }
}

}  // namespace goshawk::corridor_builder
