#pragma once

#include <span>
#include <vector>

#include "goshawk/core/result.hpp"
#include "goshawk/core/trajectory.hpp"

namespace goshawk::baselines {

/// Which derivative's squared norm a spline through waypoints minimises.
enum class Smoothness { jerk = 3, snap = 4 };

/// The smoothest piecewise polynomial through waypoints at given times, without corridor or limits:
/// degree 5 for jerk, 7 for snap, the free derivatives at the waypoints from one linear system
/// (Richter, Bry and Roy, "Polynomial Trajectory Planning for Aggressive Quadrotor Flight in Dense
/// Indoor Environments", ISRR 2013, section 3).
class PolynomialSpline {
 public:
  /// One dense system, as its authors solve it: its time grows with the cube.
  static constexpr std::size_t kMostWaypoints = 200;

  /// @param durations_s one for each pair of waypoints, above zero
  /// @param start, goal velocity and acceleration of the ends (jerk zero)
  /// @return solver_failed if the system is singular; invalid_input if sizes disagree or
  ///   there are too many waypoints
  static Result<PolynomialSpline> through(std::span<const Vec3> waypoints_map,
                                          std::span<const double> durations_s,
                                          const FlatState& start, const FlatState& goal,
                                          Smoothness smoothness);

  int segments() const { return int(durations_s_.size()); }
  double duration_s(int segment) const { return durations_s_[std::size_t(segment)]; }
  /// @param t_s in [0, duration_s(segment)]
  FlatState sample(int segment, double t_s) const;

  /// Quintic pieces that agree with position, velocity and acceleration at every knot: the whole
  /// curve for jerk; for snap what is left out shrinks with the sixth power of the piece.
  /// @return pieces of segment k name polytope k
  Trajectory to_trajectory(double longest_piece_s) const;

 private:
  // Of powers of t / duration.
  using Coefficients = Eigen::Matrix<double, 3, 8, Eigen::DontAlign>;

  std::vector<double> durations_s_;
  std::vector<Coefficients> coefficients_;
};

}  // namespace goshawk::baselines
