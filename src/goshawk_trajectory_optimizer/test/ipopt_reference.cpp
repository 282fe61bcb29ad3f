#include "ipopt_reference.hpp"

#include <IpStdCInterface.h>

#include <Eigen/Dense>
#include <functional>
#include <string>

#include "goshawk/core/trajectory.hpp"

namespace goshawk::trajectory_optimizer::test {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

// sum_i sign_i (R_i x + c_i)^2 + l x <= bound
struct Row {
  MatrixXd R;
  VectorXd c, sign, l;
  double bound = 0.0;
  std::vector<int> columns = {};  // where the gradient is not zero

  double value(const VectorXd& x) const { return l.dot(x) + (R * x + c).cwiseAbs2().dot(sign); }
  VectorXd gradient(const VectorXd& x) const {
    return l + 2.0 * R.transpose() * sign.cwiseProduct(R * x + c);
  }
};

struct Dense {
  int n = 0;
  MatrixXd P;
  VectorXd q;
  double constant = 0.0;
  std::vector<Row> rows;
  int nonzeros = 0;  // of the Jacobian

  void find_columns() {
    nonzeros = 0;
    for (Row& row : rows) {
      row.columns.clear();
      for (int j = 0; j < n; ++j) {
        const bool squared = row.R.rows() > 0 && !row.R.col(j).isZero(0.0);
        if (row.l[j] != 0.0 || squared) row.columns.push_back(j);
      }
      nonzeros += int(row.columns.size());
    }
  }
};

// A spline is affine in the unknowns: any of its points is found by probing.
class Spline {
 public:
  explicit Spline(const SplineProblem& problem) : problem_(problem) {
    unknowns_ = 9 * (problem.pieces() - 1);
  }
  int unknowns() const { return unknowns_; }

  BezierPiece piece(int k, const VectorXd& x) const {
    return BezierPiece::between(state(k, x), state(k + 1, x), problem_.durations[std::size_t(k)]);
  }
  // point = R x + c of what `pick` takes from piece k
  void affine(int k, const std::function<Vec3(const BezierPiece&)>& pick, int n, MatrixXd& R,
              VectorXd& c) const {
    VectorXd x = VectorXd::Zero(n);
    c = pick(piece(k, x));
    R = MatrixXd::Zero(3, n);
    for (int i = 9 * (k - 1); i < 9 * (k + 1); ++i) {
      if (i < 0 || i >= unknowns_) continue;
      x[i] = 1.0;
      R.col(i) = pick(piece(k, x)) - c;
      x[i] = 0.0;
    }
  }

 private:
  FlatState state(int k, const VectorXd& x) const {
    Knot knot = problem_.knots[std::size_t(k)];
    if (k > 0 && k < problem_.pieces()) {
      knot = Eigen::Map<const Knot>(x.data() + 9 * (k - 1));
    }
    FlatState s;
    s.position = knot.col(0);
    s.velocity = knot.col(1);
    s.acceleration = knot.col(2);
    return s;
  }

  const SplineProblem& problem_;
  int unknowns_ = 0;
};

void add_limit(Dense& dense, const SplineProblem& problem, const MatrixXd& R, const VectorXd& c,
               double limit, bool velocity) {
  const int n = dense.n;
  const auto add = [&](const MatrixXd& part, const VectorXd& offset, double most) {
    Row row{part, offset, VectorXd::Ones(part.rows()), VectorXd::Zero(n), most * most};
    if (problem.scale) {
      row.bound = 0.0;
      if (velocity) {
        row.l[n - 1] = -most * most;
      } else {
        row.R.conservativeResize(part.rows() + 1, n);
        row.R.row(part.rows()).setZero();
        row.R(part.rows(), n - 1) = most;
        row.c.conservativeResize(part.rows() + 1);
        row.c[part.rows()] = 0.0;
        row.sign.conservativeResize(part.rows() + 1);
        row.sign[part.rows()] = -1.0;
      }
    }
    dense.rows.push_back(row);
  };
  if (R.isZero(0.0)) return;
  switch (problem.norm) {
    case LimitNorm::euclidean:
      return add(R, c, limit);
    case LimitNorm::per_axis:
      for (int i = 0; i < 3; ++i) add(R.row(i), c.segment(i, 1), limit);
      return;
    case LimitNorm::horizontal_vertical:
      add(R.topRows(2), c.head(2), limit);
      add(R.row(2), c.tail(1),
          limit / (velocity ? problem.v_over_vertical : problem.a_over_vertical));
  }
}

Dense densify(const SplineProblem& problem, const std::vector<Polytope>& polytopes) {
  const Spline spline(problem);
  Dense dense;
  dense.n = spline.unknowns() + (problem.scale ? 1 : 0);
  dense.P = MatrixXd::Zero(dense.n, dense.n);
  dense.q = VectorXd::Zero(dense.n);
  if (problem.scale) dense.q[dense.n - 1] = problem.time_weight;
  MatrixXd R;
  VectorXd c;
  for (int k = 0; k < problem.pieces(); ++k) {
    const auto i = std::size_t(k);
    const double T = problem.durations[i];
    for (const double u : {0.5 - 0.5 * std::sqrt(0.6), 0.5, 0.5 + 0.5 * std::sqrt(0.6)}) {
      // The squared jerk is a quartic: three Gauss points integrate it exactly.
      spline.affine(
          k, [&](const BezierPiece& b) { return b.sample(u * T).jerk; }, dense.n, R, c);
      const double w = problem.jerk_weight * T * (u == 0.5 ? 4.0 / 9.0 : 5.0 / 18.0);
      dense.P += w * R.transpose() * R;
      dense.q += w * R.transpose() * c;
      dense.constant += 0.5 * w * c.squaredNorm();
    }
    for (int j = 0; j < 6; ++j) {
      spline.affine(
          k, [&](const BezierPiece& b) { return Vec3(b.control_points.col(j)); }, dense.n, R, c);
      if (R.isZero(0.0)) continue;
      for (int f = 0; f < polytopes[i].faces(); ++f) {
        Row row{MatrixXd(0, dense.n), VectorXd(0), VectorXd(0),
                R.transpose() * polytopes[i].A().row(f).transpose(), 0.0};
        row.bound = polytopes[i].b()[f] - polytopes[i].A().row(f).dot(c);
        dense.rows.push_back(row);
      }
    }
    for (int j = 0; j < 5; ++j) {
      spline.affine(
          k, [&](const BezierPiece& b) { return Vec3(b.velocity_points().col(j)); }, dense.n, R, c);
      add_limit(dense, problem, R, c, problem.v_max[i], true);
    }
    for (int j = 0; j < 4; ++j) {
      spline.affine(
          k, [&](const BezierPiece& b) { return Vec3(b.acceleration_points().col(j)); }, dense.n, R,
          c);
      add_limit(dense, problem, R, c, problem.a_max[i], false);
    }
  }
  return dense;
}

VectorXd vector(int n, const double* x) {
  return Eigen::Map<const VectorXd>(x, n);
}
const Dense& dense_of(UserDataPtr data) {
  return *static_cast<const Dense*>(data);
}

Bool evaluate(Index n, Number* x, Bool, Number* f, UserDataPtr data) {
  const Dense& d = dense_of(data);
  const VectorXd v = vector(n, x);
  *f = 0.5 * v.dot(d.P * v) + d.q.dot(v) + d.constant;
  return TRUE;
}
Bool gradient(Index n, Number* x, Bool, Number* g, UserDataPtr data) {
  const Dense& d = dense_of(data);
  Eigen::Map<VectorXd>(g, n) = d.P * vector(n, x) + d.q;
  return TRUE;
}
Bool constraints(Index n, Number* x, Bool, Index m, Number* g, UserDataPtr data) {
  const VectorXd v = vector(n, x);
  for (int i = 0; i < m; ++i) g[i] = dense_of(data).rows[std::size_t(i)].value(v);
  return TRUE;
}
Bool jacobian(Index n, Number* x, Bool, Index m, Index, Index* rows, Index* columns, Number* values,
              UserDataPtr data) {
  int next = 0;
  for (int i = 0; i < m; ++i) {
    const Row& row = dense_of(data).rows[std::size_t(i)];
    VectorXd g;
    if (values != nullptr) g = row.gradient(vector(n, x));
    for (const int j : row.columns) {
      if (values != nullptr) {
        values[next++] = g[j];
      } else {
        rows[next] = i;
        columns[next++] = j;
      }
    }
  }
  return TRUE;
}
Bool hessian(Index n, Number*, Bool, Number factor, Index m, Number* lambda, Bool, Index,
             Index* rows, Index* columns, Number* values, UserDataPtr data) {
  const Dense& d = dense_of(data);
  MatrixXd H;
  if (values != nullptr) {
    H = factor * d.P;
    for (int i = 0; i < m; ++i) {
      const Row& row = d.rows[std::size_t(i)];
      if (row.R.rows() == 0) continue;
      const int first = row.columns.front();
      const int count = std::min(18, n - first);
      const auto R = row.R.middleCols(first, count);
      H.block(first, first, count, count) +=
          2.0 * std::max(lambda[i], 0.0) * R.transpose() * row.sign.asDiagonal() * R;
      // The square of eta stands apart from the columns of the knots.
      if (first + count < n) {
        const VectorXd last = row.R.col(n - 1);
        H(n - 1, n - 1) += 2.0 * std::max(lambda[i], 0.0) * last.cwiseAbs2().dot(row.sign);
      }
    }
  }
  int next = 0;
  for (int r = 0; r < n; ++r) {
    for (int c = 0; c <= r; ++c, ++next) {
      if (values != nullptr) {
        values[next] = H(r, c);
      } else {
        rows[next] = r;
        columns[next] = c;
      }
    }
  }
  return TRUE;
}

void set_options(IpoptProblem ipopt) {
  const auto text = [&](std::string key, std::string value) {
    AddIpoptStrOption(ipopt, key.data(), value.data());
  };
  const auto number = [&](std::string key, double value) {
    AddIpoptNumOption(ipopt, key.data(), value);
  };
  const auto integer = [&](std::string key, int value) {
    AddIpoptIntOption(ipopt, key.data(), value);
  };
  integer("print_level", 0);
  text("sb", "yes");
  number("tol", 1e-9);
  number("acceptable_tol", 1e-8);
  integer("acceptable_iter", 3);
  // Multipliers stay above zero, and the Hessian of a convex problem positive.
  number("constr_mult_init_max", 0.0);
  text("alpha_for_y", "bound-mult");
  number("bound_relax_factor", 0.0);
  integer("max_iter", 100);
}

// @param x in: where to begin; out: the answer
// @param lower of the last unknown
bool minimise(Dense& dense, double lower, VectorXd& x, double& objective) {
  const int n = dense.n;
  const int m = int(dense.rows.size());
  dense.find_columns();
  VectorXd at_least = VectorXd::Constant(n, -1e20);
  VectorXd at_most = VectorXd::Constant(n, 1e20);
  at_least[n - 1] = lower;
  VectorXd row_lower = VectorXd::Constant(m, -1e20);
  VectorXd row_upper(m);
  for (int i = 0; i < m; ++i) row_upper[i] = dense.rows[std::size_t(i)].bound;
  IpoptProblem ipopt = CreateIpoptProblem(n, at_least.data(), at_most.data(), m, row_lower.data(),
                                          row_upper.data(), dense.nonzeros, n * (n + 1) / 2, 0,
                                          evaluate, constraints, gradient, jacobian, hessian);
  set_options(ipopt);
  const auto status =
      IpoptSolve(ipopt, x.data(), nullptr, &objective, nullptr, nullptr, nullptr, &dense);
  FreeIpoptProblem(ipopt);
  return status == Solve_Succeeded || status == Solved_To_Acceptable_Level;
}

// Most rows do not matter. The optimum under some of them is the optimum under all if it breaks
// none; what it breaks is added. @return false if Ipopt did not solve a round
bool minimise_under_all(const Dense& all, double lower, VectorXd& x, double& objective) {
  constexpr double kBroken = 1e-10;
  Dense some{all.n, all.P, all.q, all.constant, {}};
  std::vector<bool> taken(all.rows.size());
  for (;;) {
    bool broken = some.rows.empty();
    for (std::size_t i = 0; i < all.rows.size(); ++i) {
      const Row& row = all.rows[i];
      if (taken[i] || row.value(x) <= row.bound + kBroken * (1.0 + std::abs(row.bound))) continue;
      taken[i] = broken = true;
      some.rows.push_back(row);
    }
    if (!broken) return true;
    if (!minimise(some, lower, x, objective)) return false;
  }
}

}  // namespace

ReferenceAnswer solve_with_ipopt(const SplineProblem& problem,
                                 const std::vector<Polytope>& polytopes) {
  const Dense dense = densify(problem, polytopes);
  VectorXd x = VectorXd::Zero(dense.n);
  for (int k = 1; k < problem.pieces(); ++k) {
    Eigen::Map<Knot>(x.data() + 9 * (k - 1)) = problem.knots[std::size_t(k)];
  }
  if (problem.scale) x[dense.n - 1] = 2.0;
  ReferenceAnswer answer;
  answer.solved = minimise_under_all(dense, problem.scale ? 0.0 : -1e20, x, answer.objective);
  if (problem.scale) answer.eta = x[dense.n - 1];
  answer.knots = problem.knots;
  for (int k = 1; k < problem.pieces(); ++k) {
    answer.knots[std::size_t(k)] = Eigen::Map<Knot>(x.data() + 9 * (k - 1));
  }
  return answer;
}

double least_violation_with_ipopt(const SplineProblem& problem,
                                  const std::vector<Polytope>& polytopes) {
  Dense dense = densify(problem, polytopes);
  const int n = ++dense.n;
  dense.P = MatrixXd::Zero(n, n);
  dense.q = VectorXd::Unit(n, n - 1);
  dense.constant = 0.0;
  for (Row& row : dense.rows) {
    row.R.conservativeResize(Eigen::NoChange, n);
    row.R.col(n - 1).setZero();
    row.l.conservativeResize(n);
    row.l[n - 1] = -1.0;
  }
  VectorXd x = VectorXd::Zero(n);
  for (int k = 1; k < problem.pieces(); ++k) {
    Eigen::Map<Knot>(x.data() + 9 * (k - 1)) = problem.knots[std::size_t(k)];
  }
  for (const Row& row : dense.rows) x[n - 1] = std::max(x[n - 1], 1.0 + row.value(x) - row.bound);
  double violation = 0.0;
  return minimise_under_all(dense, -1.0, x, violation) ? violation : 0.0;
}

}  // namespace goshawk::trajectory_optimizer::test
