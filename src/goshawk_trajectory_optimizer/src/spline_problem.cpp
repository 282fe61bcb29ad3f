#include "goshawk/trajectory_optimizer/spline_problem.hpp"

namespace goshawk::trajectory_optimizer {

void SplineProblem::clear() {
  durations.clear();
  v_max.clear();
  a_max.clear();
  j_max.clear();
  knots.clear();
  face_points.clear();
  faces.clear();
  start_rate.setZero();
  goal_rate.setZero();
}

}  // namespace goshawk::trajectory_optimizer
