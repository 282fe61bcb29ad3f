#include <algorithm>
#include <cmath>

#include "spline_solver_parts.hpp"

// The Newton system of the interior-point method: with the scaling W of all cones,
//   (P + G' W^-2 G) dx = b_x + G' W^-2 q,   dz = W^-2 (G dx - q),   ds = b_z - G dx,
// q = b_z - W (lambda \ b_s) (Vandenberghe 2010, section 5). The predictor has b_x, b_z minus the
// residuals and b_s = -lambda o lambda, so that q is s minus the primal residual.
namespace goshawk::trajectory_optimizer {

void SplineSolver::evaluate_cost(double time_weight) {
  std::fill(cost_gradient_.begin(), cost_gradient_.end(), 0.0);
  cost_gradient_eta_ = scale_ ? time_weight : 0.0;
  objective_ = cost_gradient_eta_ * eta_;
  for (int k = 0; k < last_; ++k) {
    Eigen::Matrix<double, 3, 6> x;
    x << joint_of(x_, k), joint_of(x_, k + 1);
    const Eigen::Matrix<double, 3, 6> gradient = x * jerk_[std::size_t(k)];
    objective_ += 0.5 * gradient.cwiseProduct(x).sum();
    joint_of(cost_gradient_, k) += gradient.leftCols<3>();
    joint_of(cost_gradient_, k + 1) += gradient.rightCols<3>();
  }
}

// Residuals, the right-hand side of the predictor without b_x, and the reduced Hessian.
bool SplineSolver::linearise() {
  start_hessian();
  dual_ = cost_gradient_;
  dual_eta_ = cost_gradient_eta_;
  std::fill(rhs_.begin(), rhs_.end(), 0.0);
  rhs_eta_ = gap_ = proof_ = primal_residual_ = 0.0;
  linearise_faces();
  bool inside = true;
  for_each_set([&](auto& set) { inside = linearise_cones(set) && inside; });
  measure_dual_residual();
  return inside && std::isfinite(gap_);
}

void SplineSolver::start_hessian() {
  for (auto& panel : hessian_) {
    for (auto& column : panel.column) column.fill(0.0);
  }
  hessian_corner_ = 0.0;
  for (std::size_t k = 0; k < jerk_.size(); ++k) {
    const auto& q = jerk_[k];
    for (int c = 0; c < 3; ++c) {
      for (int axis = 0; axis < 3; ++axis) {
        auto& column = hessian_[k].column[std::size_t(3 * c + axis)];
        auto& next = hessian_[k + 1].column[std::size_t(3 * c + axis)];
        for (int r = 0; r < 3; ++r) {
          const auto row = std::size_t(3 * r + axis);
          column[row] += q(r, c);
          column[row + kBlock] += q(r + 3, c);
          next[row] += q(r + 3, c + 3);
        }
      }
    }
  }
}

void SplineSolver::linearise_faces() {
  for (const FacePoint& point : face_points_) {
    const Vec3 y = joint_of(x_, point.joint) * point.map;
    Vec3 gradient = Vec3::Zero();
    Vec3 rhs = Vec3::Zero();
    Eigen::Matrix3d curvature = Eigen::Matrix3d::Zero();
    for (int i = point.begin; i < point.end; ++i) {
      const Face& face = faces_[std::size_t(i)];
      FaceRow& row = rows_[std::size_t(i)];
      row.residual = face.normal.dot(y) + row.s - face.offset;
      row.inverse_s = 1.0 / row.s;
      gap_ += row.s * row.z;
      proof_ += row.z * row.residual;
      primal_residual_ = std::max(primal_residual_, std::abs(row.residual));
      const double weight = row.z * row.inverse_s;
      gradient += row.z * face.normal;
      rhs += (weight * (row.s - row.residual)) * face.normal;
      const Vec3 weighted = weight * face.normal;
      curvature += weighted * face.normal.transpose();
    }
    joint_of(dual_, point.joint) += gradient * point.map.transpose();
    joint_of(rhs_, point.joint) += rhs * point.map.transpose();
    add_diagonal(point.joint, point.map, curvature);
  }
}

template <int D, bool R>
bool SplineSolver::linearise_cones(ConeSet<D, R>& set) {
  bool inside = true;
  std::size_t next = 0;
  for (const LimitPoint& point : set.points) {
    const Vec3 y = value(point, x_);
    Vec3 gradient = Vec3::Zero();
    Vec3 rhs = Vec3::Zero();
    Hessian h;
    for (int c = 0; c < set.kConesPerPoint; ++c) {
      LimitCone<D, R>& cone = set.cones[next++];
      cone.residual = cone.s - cone.slack(component<D>(y, c), eta_);
      inside = cone.update_scaling() && inside;
      gap_ += cone.s.dot(cone.z);
      proof_ += cone.z.dot(cone.residual);
      primal_residual_ = std::max(primal_residual_, cone.residual.cwiseAbs().maxCoeff());
      const auto slope = cone.transposed(cone.z);
      component<D>(gradient, c) -= slope.y;
      dual_eta_ -= slope.eta;
      const auto pull = cone.transposed(cone.unscale_twice(cone.s - cone.residual));
      component<D>(rhs, c) -= pull.y;
      rhs_eta_ -= pull.eta;
      const auto bend = cone.curvature();
      h.yy.template block<D, D>(c, c) += bend.along * bend.direction * bend.direction.transpose();
      h.yy.template block<D, D>(c, c).diagonal().array() += bend.diagonal;
      component<D>(h.y_eta, c) += bend.mixed;
      h.eta += bend.eta;
    }
    scatter(point, gradient, dual_);
    scatter(point, rhs, rhs_);
    add_hessian(point, h);
  }
  return inside;
}

void SplineSolver::scatter(const LimitPoint& point, const Vec3& y, std::vector<double>& to) const {
  joint_of(to, point.joint) += y * point.map.from_first.transpose();
  if (point.second) joint_of(to, point.joint + 1) += y * point.map.from_second.transpose();
}

namespace {

// panel(3 i.., 3 j..) += factor * block
void add_block(ArrowCholesky::Panel& panel, int row, int column, double factor,
               const Eigen::Matrix3d& block) {
  for (int c = 0; c < 3; ++c) {
    double* const to = panel.column[std::size_t(column + c)].data() + row;
    for (int r = 0; r < 3; ++r) to[r] += factor * block(r, c);
  }
}

void add_border(ArrowCholesky::Panel& panel, const Vec3& map, const Vec3& border) {
  for (int i = 0; i < 3; ++i) {
    for (int r = 0; r < 3; ++r) {
      panel.column[std::size_t(3 * i + r)][ArrowCholesky::kBorder] += map[i] * border[r];
    }
  }
}

}  // namespace

void SplineSolver::add_diagonal(int joint, const Vec3& map, const Eigen::Matrix3d& block) {
  auto& panel = hessian_[std::size_t(joint)];
  for (int j = 0; j < 3; ++j) {
    if (map[j] == 0.0) continue;
    for (int i = j; i < 3; ++i) {
      if (map[i] != 0.0) add_block(panel, 3 * i, 3 * j, map[i] * map[j], block);
    }
  }
}

void SplineSolver::add_hessian(const LimitPoint& point, const Hessian& h) {
  auto& panel = hessian_[std::size_t(point.joint)];
  add_diagonal(point.joint, point.map.from_first, h.yy);
  if (point.second) {
    add_diagonal(point.joint + 1, point.map.from_second, h.yy);
    for (int j = 0; j < 3; ++j) {
      if (point.map.from_first[j] == 0.0) continue;
      for (int i = 0; i < 3; ++i) {
        add_block(panel, kBlock + 3 * i, 3 * j, point.map.from_second[i] * point.map.from_first[j],
                  h.yy);
      }
    }
  }
  if (!scale_) return;
  add_border(panel, point.map.from_first, h.y_eta);
  if (point.second) {
    add_border(hessian_[std::size_t(point.joint) + 1], point.map.from_second, h.y_eta);
  }
  hessian_corner_ += h.eta;
}

void SplineSolver::measure_dual_residual() {
  double residual = 0.0;
  double size = 1.0;
  multiplier_residual_ = 0.0;
  const auto account = [&](double dual, double cost) {
    residual = std::max(residual, std::abs(dual));
    size = std::max(size, std::abs(cost));
    multiplier_residual_ += std::abs(dual - cost);
  };
  for (std::size_t i = kBlock; i < std::size_t(last_) * kBlock; ++i) {
    account(dual_[i], cost_gradient_[i]);
  }
  if (scale_) {
    const auto folded = [&](const std::vector<double>& g, double eta) {
      return eta + joint_of(g, 0).cwiseProduct(start_rate_).sum() +
             joint_of(g, last_).cwiseProduct(goal_rate_).sum();
    };
    account(folded(dual_, dual_eta_), folded(cost_gradient_, cost_gradient_eta_));
  }
  dual_residual_ = residual / size;
}

// Farkas: for any x', z'(G x' - h) = z'(G x + s - h) - s'z + (G'z)'(x' - x). Where that is above
// zero for every x' within reach of x, no x' within reach satisfies G x' <= h.
bool SplineSolver::proves_infeasible() const {
  constexpr double kReach = 1e4;  // in the problem's units, in which a piece is about 1
  return proof_ - gap_ > kReach * multiplier_residual_;
}

bool SplineSolver::factor() {
  factors_.resize(std::max(0, last_ - 1));
  for (int k = 1; k < last_; ++k) factors_.panel(k - 1) = hessian_[std::size_t(k)];
  factors_.corner() = 1.0;
  if (scale_) fold_ends();
  if (last_ >= 2) {  // what couples to the goal is in the border now
    for (auto& column : factors_.panel(last_ - 2).column) {
      std::fill(column.begin() + kBlock, column.begin() + 2 * kBlock, 0.0);
    }
  }
  return factors_.factor();
}

// The ends are affine in eta: what they would have added goes to the border.
void SplineSolver::fold_ends() {
  const Eigen::Map<const Eigen::Matrix<double, 9, 1>> start(start_rate_.data());
  const Eigen::Map<const Eigen::Matrix<double, 9, 1>> goal(goal_rate_.data());
  double corner = hessian_corner_;
  for (int end = 0; end < 2; ++end) {
    const auto& rate = end == 0 ? start : goal;
    const auto& panel = hessian_[end == 0 ? 0 : std::size_t(last_)];
    for (int c = 0; c < kBlock; ++c) {
      const auto& column = panel.column[std::size_t(c)];
      corner += 2.0 * rate[c] * column[ArrowCholesky::kBorder];
      corner += rate[c] * rate[c] * column[std::size_t(c)];
      for (int r = c + 1; r < kBlock; ++r)
        corner += 2.0 * rate[c] * rate[r] * column[std::size_t(r)];
    }
  }
  const auto below = [&](int k, int r, int c) {
    return hessian_[std::size_t(k)].column[std::size_t(c)][std::size_t(kBlock + r)];
  };
  for (int r = 0; r < kBlock; ++r) {
    for (int c = 0; c < kBlock; ++c) {
      if (last_ == 1) {
        corner += 2.0 * goal[r] * below(0, r, c) * start[c];
        continue;
      }
      auto& first = factors_.panel(0).column[std::size_t(r)];
      auto& final = factors_.panel(last_ - 2).column[std::size_t(c)];
      first[ArrowCholesky::kBorder] += below(0, r, c) * start[c];
      final[ArrowCholesky::kBorder] += goal[r] * below(last_ - 1, r, c);
    }
  }
  factors_.corner() = corner;
}

// In: rhs_, rhs_eta_ over all joints. Out: dx_, deta_ over all joints.
void SplineSolver::solve_newton() {
  deta_ = 0.0;
  if (scale_) {
    deta_ = rhs_eta_ + joint_of(rhs_, 0).cwiseProduct(start_rate_).sum() +
            joint_of(rhs_, last_).cwiseProduct(goal_rate_).sum();
  }
  newton_.assign(rhs_.begin() + kBlock, rhs_.end());  // the goal's place is the padding
  factors_.solve(newton_, deta_);
  std::copy(newton_.begin(), newton_.end(), dx_.begin() + kBlock);
  joint_of(dx_, 0) = deta_ * start_rate_;
  joint_of(dx_, last_) = deta_ * goal_rate_;
}

// @return the step to the boundary along the predictor
double SplineSolver::predict() {
  for (std::size_t i = 0; i < rhs_.size(); ++i) rhs_[i] -= dual_[i];
  rhs_eta_ -= dual_eta_;
  solve_newton();
  double largest = 1e-300;  // inverse of the step
  for (const FacePoint& point : face_points_) {
    const Vec3 dy = joint_of(dx_, point.joint) * point.map;
    for (int i = point.begin; i < point.end; ++i) {
      FaceRow& row = rows_[std::size_t(i)];
      const double along = faces_[std::size_t(i)].normal.dot(dy);
      const double ratio = (along - row.s + row.residual) * row.inverse_s;  // dz / z
      row.dz = ratio * row.z;
      row.ds = -row.residual - along;
      largest = std::max({largest, -ratio, 1.0 + ratio});  // ds / s + dz / z = -1
    }
  }
  double step = 1.0 / largest;
  for_each_set([&](auto& set) {
    for_each_cone(set, dx_, [&](auto& cone, const auto& dy) {
      const auto move = cone.direction_of(dy, deta_);
      cone.dz = -cone.unscale_twice(move + cone.s - cone.residual);
      cone.ds = move - cone.residual;
      cone.scaled_dz = cone.scale(cone.dz);
      step = std::min(step, cone.step_to_boundary());
    });
  });
  return step;
}

// The predictor's second-order terms and the centring sigma; the residuals enter whole, not
// (1 - sigma) of them: a full step then ends them. @return the step to the boundary
double SplineSolver::correct(double sigma) {
  const double target = sigma * gap_ / degree_;
  for (std::size_t i = 0; i < rhs_.size(); ++i) rhs_[i] = -dual_[i];
  rhs_eta_ = -dual_eta_;
  for (const FacePoint& point : face_points_) {
    Vec3 rhs = Vec3::Zero();
    for (int i = point.begin; i < point.end; ++i) {
      FaceRow& row = rows_[std::size_t(i)];
      const double product = target - row.s * row.z - row.ds * row.dz;  // b_s
      row.dz = -(row.residual * row.z + product) * row.inverse_s;       // W^-2 q for now
      rhs += row.dz * faces_[std::size_t(i)].normal;
    }
    joint_of(rhs_, point.joint) += rhs * point.map.transpose();
  }
  for_each_set([&](auto& set) { correct_cones(set, target); });
  solve_newton();
  return final_direction();
}

template <int D, bool R>
void SplineSolver::correct_cones(ConeSet<D, R>& set, double target) {
  std::size_t next = 0;
  for (const LimitPoint& point : set.points) {
    Vec3 rhs = Vec3::Zero();
    for (int c = 0; c < set.kConesPerPoint; ++c) {
      LimitCone<D, R>& cone = set.cones[next++];
      typename LimitCone<D, R>::Vector product =
          cone.jordan(cone.lambda + cone.scaled_dz, cone.scaled_dz) -
          cone.jordan(cone.lambda, cone.lambda);
      product[0] += target;
      cone.dz = -cone.unscale_twice(cone.residual + cone.scale(cone.divide_by_lambda(product)));
      const auto pull = cone.transposed(cone.dz);
      component<D>(rhs, c) -= pull.y;
      rhs_eta_ -= pull.eta;
    }
    scatter(point, rhs, rhs_);
  }
}

double SplineSolver::final_direction() {
  double largest = 1e-300;
  for (const FacePoint& point : face_points_) {
    const Vec3 dy = joint_of(dx_, point.joint) * point.map;
    for (int i = point.begin; i < point.end; ++i) {
      FaceRow& row = rows_[std::size_t(i)];
      const double along = faces_[std::size_t(i)].normal.dot(dy);
      row.dz = row.z * row.inverse_s * along - row.dz;
      row.ds = -row.residual - along;
      largest = std::max({largest, -row.ds * row.inverse_s, -row.dz / row.z});
    }
  }
  double step = 1.0 / largest;
  for_each_set([&](auto& set) {
    for_each_cone(set, dx_, [&](auto& cone, const auto& dy) {
      const auto move = cone.direction_of(dy, deta_);
      cone.dz = -cone.unscale_twice(move) - cone.dz;
      cone.ds = move - cone.residual;
      step = std::min(step, cone.step_to_boundary());
    });
  });
  return step;
}

}  // namespace goshawk::trajectory_optimizer
