#pragma once

#include <span>
#include <vector>

#include "goshawk/trajectory_optimizer/spline_solver.hpp"
#include "spline_state.hpp"

namespace goshawk::trajectory_optimizer {

/// The vectors behind a SplineState, and how a problem gets into them.
struct SplineSolver::Memory {
  SplineState state;
  bool constant_point_violated = false;

  void load(const SplineProblem& problem);
  /// Slacks near what the guess gives, multipliers that make every product equal: a start on the
  /// central path, for the price of one pass.
  void start();
  Knot knot(int k) const;
  void set_knots(const std::vector<Knot>& knots);

 private:
  void smooth_guess();
  void load_knots(const SplineProblem& problem);
  void load_faces(const SplineProblem& problem);
  void load_planes(std::span<const HalfSpace> faces);
  void load_limits(const SplineProblem& problem);
  void load_limit(const SplineProblem& problem, int k, int order, LimitLanes& to);
  bool is_row(const PointMap& map, int k, double limit, const LimitSet& set);

  struct Triple {
    Lanes v[3];
  };
  struct Jerk {
    double q[36];
  };
  double jerk_weight_ = 1.0;
  std::vector<Triple> x_, dx_, rhs_, rates_;
  std::vector<Jerk> jerk_;
  std::vector<FaceRange> ranges_;
  std::vector<FourFaces> planes_;
  std::vector<Row> faces_;
  std::vector<LimitLanes> velocity_, acceleration_, jerk_limit_;
  std::vector<KnotSums> knots_;
  std::vector<PieceSums> pieces_;
  std::vector<Panel> panels_;
};

}  // namespace goshawk::trajectory_optimizer
