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
    for (Row& row : rows) {
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
    Joint joint = problem_.joints[std::size_t(k)];
    if (k > 0 && k < problem_.pieces()) {
      joint = Eigen::Map<const Joint>(x.data() + 9 * (k - 1));
    }
    FlatState s;
    s.position = joint.col(0);
    s.velocity = joint.col(1);
    s.acceleration = joint.col(2);
    return s;
  }

  const SplineProblem& problem_;
  int unknowns_ = 0;
};

void add_limit(Dense& dense, const SplineProblem& problem, const MatrixXd& R, const VectorXd& c,
               double limit, bool velocity) {
  const int n = dense.n;
  const auto add = [&](const MatrixXd& part, const VectorXd& offset) {
    Row row{part, offset, VectorXd::Ones(part.rows()), VectorXd::Zero(n), limit * limit};
    if (problem.scale) {
      row.bound = 0.0;
      if (velocity) {
        row.l[n - 1] = -limit * limit;
      } else {
        row.R.conservativeResize(part.rows() + 1, n);
        row.R.row(part.rows()).setZero();
        row.R(part.rows(), n - 1) = limit;
        row.c.conservativeResize(part.rows() + 1);
        row.c[part.rows()] = 0.0;
        row.sign.conservativeResize(part.rows() + 1);
        row.sign[part.rows()] = -1.0;
      }
    }
    dense.rows.push_back(row);
  };
  if (R.isZero(0.0)) return;
  if (problem.norm == LimitNorm::euclidean) return add(R, c);
  for (int i = 0; i < 3; ++i) add(R.row(i), c.segment(i, 1));
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
                R.transpose() * polytopes[i].A.row(f).transpose(), 0.0};
        row.bound = polytopes[i].b[f] - polytopes[i].A.row(f).dot(c);
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
          2.0 * lambda[i] * R.transpose() * row.sign.asDiagonal() * R;
      // The square of eta stands apart from the columns of the joints.
      if (first + count < n) {
        const VectorXd last = row.R.col(n - 1);
        H(n - 1, n - 1) += 2.0 * lambda[i] * last.cwiseAbs2().dot(row.sign);
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
  number("tol", 1e-10);
  number("bound_relax_factor", 0.0);
  integer("max_iter", 300);
}

}  // namespace

ReferenceAnswer solve_with_ipopt(const SplineProblem& problem,
                                 const std::vector<Polytope>& polytopes) {
  Dense dense = densify(problem, polytopes);
  dense.find_columns();
  const int n = dense.n;
  const int m = int(dense.rows.size());
  VectorXd lower = VectorXd::Constant(n, -1e20);
  VectorXd upper = VectorXd::Constant(n, 1e20);
  if (problem.scale) lower[n - 1] = 0.0;
  VectorXd row_lower = VectorXd::Constant(m, -1e20);
  VectorXd row_upper(m);
  for (int i = 0; i < m; ++i) row_upper[i] = dense.rows[std::size_t(i)].bound;
  VectorXd x = VectorXd::Zero(n);
  for (int k = 1; k < problem.pieces(); ++k) {
    Eigen::Map<Joint>(x.data() + 9 * (k - 1)) = problem.joints[std::size_t(k)];
  }
  if (problem.scale) x[n - 1] = 2.0;
  IpoptProblem ipopt = CreateIpoptProblem(n, lower.data(), upper.data(), m, row_lower.data(),
                                          row_upper.data(), dense.nonzeros, n * (n + 1) / 2, 0,
                                          evaluate, constraints, gradient, jacobian, hessian);
  set_options(ipopt);
  ReferenceAnswer answer;
  const auto status =
      IpoptSolve(ipopt, x.data(), nullptr, &answer.objective, nullptr, nullptr, nullptr, &dense);
  FreeIpoptProblem(ipopt);
  answer.solved = status == Solve_Succeeded;
  answer.infeasible = status == Infeasible_Problem_Detected;
  if (problem.scale) answer.eta = x[n - 1];
  answer.joints = problem.joints;
  for (int k = 1; k < problem.pieces(); ++k) {
    answer.joints[std::size_t(k)] = Eigen::Map<Joint>(x.data() + 9 * (k - 1));
  }
  return answer;
}

}  // namespace goshawk::trajectory_optimizer::test
