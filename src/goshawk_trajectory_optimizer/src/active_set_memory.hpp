#pragma once

#include <vector>

#include "active_set_state.hpp"
#include "goshawk/trajectory_optimizer/active_set_solver.hpp"

namespace goshawk::trajectory_optimizer {

/// The vectors behind an ActiveSetState, and how a problem gets into them.
struct ActiveSetSolver::Memory {
  ActiveSetState state;
  bool finite = true;              // faces and knots
  bool constant_violated = false;  // a point that the ends alone decide
  /// No trajectory within the acceleration limits has a larger objective.
  double most_objective = 0.0;

  void load(const SplineProblem& problem);
  Knot knot(int k) const;

 private:
  void load_knots(const SplineProblem& problem);
  void load_faces(const SplineProblem& problem);
  void pack_faces(const SplineProblem& problem, const FacePoint& point);
  void check_constant(const SplineProblem& problem, const FacePoint& point);
  void load_limits(const SplineProblem& problem);
  void load_limit(const SplineProblem& problem, int k, int derivative, PricedLimits& to);
  bool check_constant(const PointMap& map, int k, double limit, const PricedSet& set);
  void reserve_working_set();

  struct Four {
    Lanes v;
  };
  struct Jerk {
    double q[36];
  };
  std::vector<Four> x_, free_, work_, residual_, root_, column_, image_, change_;
  std::vector<Jerk> jerk_;
  std::vector<KnotFactor> factors_;
  std::vector<PricedPoint> points_;
  std::vector<FourFaces> faces_;  // points with the same faces share them
  int first_packed_ = 0;
  std::vector<PricedLimits> limits_[kDerivatives];
  std::vector<Constraint> active_;
};

}  // namespace goshawk::trajectory_optimizer
