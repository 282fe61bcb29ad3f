#pragma once

// Inside spline_solver.cpp and spline_newton.cpp only.
#include <Eigen/Core>
#include <vector>

#include "goshawk/trajectory_optimizer/spline_solver.hpp"

namespace goshawk::trajectory_optimizer {

inline constexpr int kBlock = ArrowCholesky::kBlock;

inline Eigen::Map<Joint> joint_of(std::vector<double>& x, int k) {
  return Eigen::Map<Joint>(x.data() + std::size_t(k) * kBlock);
}
inline Eigen::Map<const Joint> joint_of(const std::vector<double>& x, int k) {
  return Eigen::Map<const Joint>(x.data() + std::size_t(k) * kBlock);
}

// The components of a point that cone c of its cones sees.
template <int D>
auto component(Vec3& y, int c) {
  return y.segment<D>(c);
}
template <int D>
Eigen::Matrix<double, D, 1> component(const Vec3& y, int c) {
  return y.segment<D>(c);
}

template <int D, bool R, typename Visit>
void SplineSolver::for_each_cone(ConeSet<D, R>& set, const std::vector<double>& x, Visit&& visit) {
  std::size_t next = 0;
  for (const LimitPoint& point : set.points) {
    const Vec3 y = value(point, x);
    for (int c = 0; c < 3 / D; ++c) visit(set.cones[next++], component<D>(y, c));
  }
}

inline Vec3 SplineSolver::value(const LimitPoint& point, const std::vector<double>& x) const {
  Vec3 y = joint_of(x, point.joint) * point.map.from_first;
  if (point.second) y += joint_of(x, point.joint + 1) * point.map.from_second;
  return y;
}

}  // namespace goshawk::trajectory_optimizer
