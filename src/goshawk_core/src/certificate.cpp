#include "goshawk/core/certificate.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <limits>
#include <utility>

namespace goshawk {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

// The larger violation. NaN is the worst of all and stays; std::max would lose it.
void raise(double& worst, double violation) {
  if (!std::isnan(worst) && !(violation <= worst)) worst = violation;
}

template <typename Points>
double size_of_largest(const Points& points, LimitNorm norm) {
  return norm == LimitNorm::euclidean
             ? points.colwise().norm().template maxCoeff<Eigen::PropagateNaN>()
             : points.cwiseAbs().template maxCoeff<Eigen::PropagateNaN>();
}

double difference(const FlatState& a, const FlatState& b) {
  double worst = (a.position - b.position).norm();
  raise(worst, (a.velocity - b.velocity).norm());
  raise(worst, (a.acceleration - b.acceleration).norm());
  return worst;
}

double position_violation(const BezierPiece& piece, const Polytope& polytope) {
  if (!polytope.check()) return kNaN;
  double worst = polytope.violation(piece.control_points.col(0));
  for (int j = 1; j < 6; ++j) raise(worst, polytope.violation(piece.control_points.col(j)));
  return worst;
}

void certify_piece(const BezierPiece& piece, const Polytope& polytope, const Limits& limits,
                   Certificate& c) {
  raise(c.position_m, position_violation(piece, polytope));
  // A negative duration would turn the velocity round and keep its length.
  const bool sound = piece.duration_s > 0.0 && limits.check().ok();
  raise(c.velocity_m_s,
        sound ? size_of_largest(piece.velocity_points(), limits.norm) - limits.v_max_m_s : kNaN);
  raise(
      c.acceleration_m_s2,
      sound ? size_of_largest(piece.acceleration_points(), limits.norm) - limits.a_max_m_s2 : kNaN);
}

void certify_joint(const BezierPiece& before, const BezierPiece& after, Certificate& c) {
  const auto end = before.sample(before.duration_s);
  const auto begin = after.sample(0.0);
  raise(c.joint_position_m, (end.position - begin.position).norm());
  raise(c.joint_velocity_m_s, (end.velocity - begin.velocity).norm());
  raise(c.joint_acceleration_m_s2, (end.acceleration - begin.acceleration).norm());
}

std::array<std::pair<const char*, double>, 8> families(const Certificate& c) {
  return {{{"position", c.position_m},
           {"velocity", c.velocity_m_s},
           {"acceleration", c.acceleration_m_s2},
           {"joint position", c.joint_position_m},
           {"joint velocity", c.joint_velocity_m_s},
           {"joint acceleration", c.joint_acceleration_m_s2},
           {"start", c.start_m},
           {"goal", c.goal_m}}};
}

}  // namespace

Status Limits::check() const {
  std::string faults;
  const auto positive = [&](const char* name, double value) {
    if (std::isfinite(value) && value > 0.0) return;
    faults += std::string(faults.empty() ? "" : "; ") + name + " is " + std::to_string(value);
  };
  positive("v_max_m_s", v_max_m_s);
  positive("a_max_m_s2", a_max_m_s2);
  if (faults.empty()) return success();
  return fail(ErrorCode::invalid_limits, faults + ": a limit must be finite and above zero");
}

bool Certificate::holds(double tolerance) const {
  // Written so that NaN fails.
  return std::ranges::all_of(families(*this),
                             [&](const auto& family) { return family.second <= tolerance; });
}

std::string Certificate::worst() const {
  const auto all = families(*this);
  const auto& [name, value] = *std::ranges::max_element(
      all, {}, [](const auto& f) { return std::isnan(f.second) ? HUGE_VAL : f.second; });
  char text[80];
  std::snprintf(text, sizeof text, "%s is violated by %.3g", name, value);
  return text;
}

Certificate certify(const Trajectory& trajectory, std::span<const Polytope> polytopes,
                    const Limits& limits, const FlatState& start, const FlatState& goal) {
  if (trajectory.pieces.empty()) throw std::logic_error("certify() of no pieces");
  constexpr double none = -std::numeric_limits<double>::infinity();
  Certificate c{.position_m = none, .velocity_m_s = none, .acceleration_m_s2 = none};
  const BezierPiece* before = nullptr;
  for (const auto& piece : trajectory.pieces) {
    if (piece.polytope < 0 || std::size_t(piece.polytope) >= polytopes.size()) {
      throw std::out_of_range("certify(): a piece names polytope " +
                              std::to_string(piece.polytope) + ", which is not there");
    }
    certify_piece(piece, polytopes[std::size_t(piece.polytope)], limits, c);
    if (before != nullptr) certify_joint(*before, piece, c);
    before = &piece;
  }
  const auto& last = trajectory.pieces.back();
  c.start_m = difference(trajectory.pieces.front().sample(0.0), start);
  c.goal_m = difference(last.sample(last.duration_s), goal);
  return c;
}

}  // namespace goshawk
