#pragma once

#include <vector>

#include "goshawk/trajectory_optimizer/arrow_cholesky.hpp"
#include "goshawk/trajectory_optimizer/limit_cone.hpp"
#include "goshawk/trajectory_optimizer/spline_problem.hpp"

namespace goshawk::trajectory_optimizer {

/// Primal-dual interior-point method for SplineProblem: Mehrotra's predictor-corrector with
/// Nesterov-Todd scaling, the Newton system reduced to the joints and factored as an
/// ArrowCholesky. Work of an iteration is linear in pieces and faces. A solver keeps its memory:
/// nothing is allocated in a solve no larger than an earlier one, and no answer depends on an
/// earlier one.
class SplineSolver {
 public:
  struct Settings {
    int max_iterations = 60;
    double gap = 1e-8;               // relative duality gap
    double feasibility = 1e-9;       // primal residual
    double dual_feasibility = 1e-7;  // dual residual, relative
  };
  enum class Status { solved, infeasible, iteration_limit, numerical_trouble };
  struct Outcome {
    Status status = Status::numerical_trouble;
    int iterations = 0;
    double objective = 0.0;
    double gap = 0.0;              // s'z
    double primal_residual = 0.0;  // largest |G x + s - h|
    double dual_residual = 0.0;    // largest |P x + q + G'z|, relative to the cost's gradient
    double eta = 1.0;
  };

  /// The solution is in joints() and the outcome's eta. @pre the problem's sizes agree
  Outcome solve(const SplineProblem& problem, const Settings& settings);

  const std::vector<Joint>& joints() const { return solution_; }

 private:
  struct FaceRow {
    double s = 0.0, z = 0.0;
    double residual = 0.0, inverse_s = 0.0;
    double ds = 0.0, dz = 0.0;
  };
  // A velocity or acceleration control point: a map of the joints k and k + 1 (or of k alone).
  struct LimitPoint {
    int joint;
    bool second;
    PointMap map;
    double limit;
  };
  // Of one control point y and eta.
  struct Hessian {
    Eigen::Matrix3d yy = Eigen::Matrix3d::Zero();
    Vec3 y_eta = Vec3::Zero();
    double eta = 0.0;
  };
  // All cones of one kind; 3 / D for each point.
  template <int D, bool Rotated>
  struct ConeSet {
    static constexpr int kConesPerPoint = 3 / D;
    std::vector<LimitPoint> points;
    std::vector<LimitCone<D, Rotated>> cones;
  };

  void set_up(const SplineProblem& problem);
  void add_limits(const SplineProblem& problem);
  void add_limit(const SplineProblem& problem, bool velocity, const LimitPoint& point);
  bool moves(int joint) const;
  bool touches_unknown(const LimitPoint& point) const;
  void start_iterates(double time_weight);

  void evaluate_cost(double time_weight);
  bool linearise();
  void start_hessian();
  void linearise_faces();
  template <int D, bool R>
  bool linearise_cones(ConeSet<D, R>& set);
  void measure_dual_residual();
  bool proves_infeasible() const;

  bool factor();
  void fold_ends();
  void solve_newton();
  double predict();
  double correct(double sigma);
  template <int D, bool R>
  void correct_cones(ConeSet<D, R>& set, double target);
  double final_direction();
  void apply_step(double step);

  template <typename Visit>
  void for_each_set(Visit&& visit) {
    visit(velocity_);
    visit(plain_);
    visit(velocity_axis_);
    visit(plain_axis_);
  }
  // visit(cone, its components of the point's map of x)
  template <int D, bool R, typename Visit>
  void for_each_cone(ConeSet<D, R>& set, const std::vector<double>& x, Visit&& visit);
  Vec3 value(const LimitPoint& point, const std::vector<double>& x) const;
  void scatter(const LimitPoint& point, const Vec3& y, std::vector<double>& to) const;
  void add_hessian(const LimitPoint& point, const Hessian& h);
  void add_diagonal(int joint, const Vec3& map, const Eigen::Matrix3d& block);

  int last_ = 0;  // index of the last joint = number of pieces
  bool scale_ = true;
  bool constant_point_violated_ = false;
  double degree_ = 1.0;  // of the product of all cones
  Joint start_rate_ = Joint::Zero(), goal_rate_ = Joint::Zero();
  std::vector<Joint> solution_;
  std::vector<FacePoint> face_points_;
  std::vector<Face> faces_;
  std::vector<FaceRow> rows_;
  ConeSet<3, true> velocity_;
  ConeSet<3, false> plain_;
  ConeSet<1, true> velocity_axis_;
  ConeSet<1, false> plain_axis_;

  // Vectors over all joints, 9 values each; the component of eta stands beside them.
  std::vector<double> x_, cost_gradient_, dual_, rhs_, dx_, newton_;
  double eta_ = 1.0, cost_gradient_eta_ = 0.0, dual_eta_ = 0.0, rhs_eta_ = 0.0, deta_ = 0.0;
  double objective_ = 0.0, gap_ = 0.0, primal_residual_ = 0.0, dual_residual_ = 0.0;
  double multiplier_residual_ = 0.0;  // sum of |G'z| over the unknowns
  double proof_ = 0.0;                // z' (G x + s - h)
  std::vector<Eigen::Matrix<double, 6, 6>> jerk_;
  std::vector<ArrowCholesky::Panel> hessian_;  // over all joints, the ends included
  double hessian_corner_ = 0.0;
  ArrowCholesky factors_;
};

}  // namespace goshawk::trajectory_optimizer
