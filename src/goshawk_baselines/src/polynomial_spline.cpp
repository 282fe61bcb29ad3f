#include "goshawk/baselines/polynomial_spline.hpp"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

namespace goshawk::baselines {
namespace {

using Eigen::MatrixXd;

double falling(int n, int k) {  // n (n - 1) ... (n - k + 1)
  double product = 1.0;
  for (int i = 0; i < k; ++i) product *= n - i;
  return product;
}

// Coefficients of powers of tau in [0, 1] from the first r derivatives by tau at both ends.
MatrixXd from_ends(int r) {
  MatrixXd ends = MatrixXd::Zero(2 * r, 2 * r);
  for (int d = 0; d < r; ++d) {
    ends(d, d) = falling(d, d);
    for (int n = d; n < 2 * r; ++n) ends(r + d, n) = falling(n, d);
  }
  return ends.inverse();
}

// x' Q x is the integral of the squared r-th derivative by tau, x the derivatives at both ends.
MatrixXd cost_of_ends(int r) {
  MatrixXd cost = MatrixXd::Zero(2 * r, 2 * r);
  for (int a = r; a < 2 * r; ++a) {
    for (int b = r; b < 2 * r; ++b) {
      cost(a, b) = falling(a, r) * falling(b, r) / (a + b - 2 * r + 1);
    }
  }
  const MatrixXd coefficients = from_ends(r);
  return coefficients.transpose() * cost * coefficients;
}

// All derivatives at all waypoints, row (waypoint r + order): known ones filled in.
MatrixXd known_derivatives(std::span<const Vec3> waypoints, const FlatState& start,
                           const FlatState& goal, int r) {
  MatrixXd x = MatrixXd::Zero(Eigen::Index(waypoints.size()) * r, 3);
  for (std::size_t k = 0; k < waypoints.size(); ++k) {
    x.row(Eigen::Index(k) * r) = waypoints[k].transpose();
  }
  x.row(1) = start.velocity.transpose();
  x.row(2) = start.acceleration.transpose();
  x.row(x.rows() - r + 1) = goal.velocity.transpose();
  x.row(x.rows() - r + 2) = goal.acceleration.transpose();
  return x;
}

// Minimises over the derivatives of the inner waypoints.
bool fill_free_derivatives(std::span<const double> durations, int r, MatrixXd& x) {
  const MatrixXd unit = cost_of_ends(r);
  const Eigen::Index n = x.rows();
  MatrixXd cost = MatrixXd::Zero(n, n);
  for (std::size_t k = 0; k < durations.size(); ++k) {
    const double T = durations[k];
    Eigen::VectorXd scale(2 * r);  // derivatives by t to derivatives by tau
    for (int d = 0; d < r; ++d) scale[d] = scale[r + d] = std::pow(T, d);
    cost.block(Eigen::Index(k) * r, Eigen::Index(k) * r, 2 * r, 2 * r) +=
        std::pow(T, 1 - 2 * r) * scale.asDiagonal() * unit * scale.asDiagonal();
  }
  std::vector<Eigen::Index> free;
  for (std::size_t k = 1; k < durations.size(); ++k) {
    for (int d = 1; d < r; ++d) free.push_back(Eigen::Index(k) * r + d);
  }
  if (free.empty()) return true;
  const MatrixXd gradient = cost * x;
  const MatrixXd rhs = -gradient(free, Eigen::all);
  const MatrixXd system = cost(free, free);
  const Eigen::LDLT<MatrixXd> factors(system);
  if (factors.info() != Eigen::Success || !factors.isPositive()) return false;
  const MatrixXd solution = factors.solve(rhs);
  x(free, Eigen::all) = solution;
  return x.allFinite();
}

Status check(std::size_t waypoints, std::span<const double> durations) {
  if (waypoints < 2 || durations.size() + 1 != waypoints) {
    return fail(ErrorCode::invalid_input,
                fmt::format("{} waypoints and {} durations: n + 1 and n are needed", waypoints,
                            durations.size()));
  }
  if (waypoints > PolynomialSpline::kMostWaypoints) {
    return fail(ErrorCode::invalid_input,
                fmt::format("{} waypoints are too many for one polynomial system, which takes {} "
                            "at most: use trajectory_optimizer",
                            waypoints, PolynomialSpline::kMostWaypoints));
  }
  for (const double T : durations) {
    if (std::isfinite(T) && T > 0.0) continue;
    return fail(ErrorCode::invalid_input,
                fmt::format("a duration of {} s: it must be finite and above zero", T));
  }
  return success();
}

}  // namespace

Result<PolynomialSpline> PolynomialSpline::through(std::span<const Vec3> waypoints,
                                                   std::span<const double> durations,
                                                   const FlatState& start, const FlatState& goal,
                                                   Smoothness smoothness) {
  if (auto status = check(waypoints.size(), durations); !status) return status.error();
  const int r = int(smoothness);
  MatrixXd x = known_derivatives(waypoints, start, goal, r);
  if (!fill_free_derivatives(durations, r, x)) {
    return fail(ErrorCode::solver_failed,
                "the smoothest polynomial through the waypoints cannot be computed: look for "
                "waypoints that nearly coincide");
  }
  const MatrixXd coefficients = from_ends(r);
  PolynomialSpline spline;
  spline.durations_s_.assign(durations.begin(), durations.end());
  for (std::size_t k = 0; k < durations.size(); ++k) {
    MatrixXd ends = x.middleRows(Eigen::Index(k) * r, 2 * r);
    for (int d = 0; d < r; ++d) {
      ends.row(d) *= std::pow(durations[k], d);
      ends.row(r + d) *= std::pow(durations[k], d);
    }
    Coefficients& c = spline.coefficients_.emplace_back(Coefficients::Zero());
    c.leftCols(2 * r) = (coefficients * ends).transpose();
  }
  return spline;
}

FlatState PolynomialSpline::sample(int segment, double t_s) const {
  const Coefficients& c = coefficients_[std::size_t(segment)];
  const double T = duration_s(segment);
  const double tau = std::clamp(t_s / T, 0.0, 1.0);
  Vec3 derivative[4];
  for (int d = 0; d < 4; ++d) {
    derivative[d] = Vec3::Zero();
    for (int n = 7; n >= d; --n) derivative[d] = derivative[d] * tau + falling(n, d) * c.col(n);
    derivative[d] /= std::pow(T, d);
  }
  return {derivative[0], derivative[1], derivative[2], derivative[3]};
}

Trajectory PolynomialSpline::to_trajectory(double longest_piece_s) const {
  Trajectory trajectory;
  for (int k = 0; k < segments(); ++k) {
    const int pieces = int(std::clamp(std::ceil(duration_s(k) / longest_piece_s), 1.0, 10000.0));
    const double T = duration_s(k) / pieces;
    for (int i = 0; i < pieces; ++i) {
      trajectory.pieces.push_back(
          BezierPiece::between(sample(k, i * T), sample(k, (i + 1) * T), T));
      trajectory.pieces.back().polytope = k;
    }
  }
  return trajectory;
}

}  // namespace goshawk::baselines
