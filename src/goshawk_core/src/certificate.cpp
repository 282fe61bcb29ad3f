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
constexpr double kNoExcess = 1e-6;  // of a limit: rounding, not an excess

// The larger violation. NaN is the worst of all and stays; std::max would lose it.
void raise(double& worst, double violation) {
  if (!std::isnan(worst) && !(violation <= worst)) worst = violation;
}

// The largest use of a limit by any of the points (columns).
template <typename Points, typename Use>
double largest_use(const Points& points, Use&& use) {
  double worst = 0.0;
  for (int j = 0; j < points.cols(); ++j) raise(worst, use(Vec3(points.col(j))));
  return worst;
}

double norm_of(const Vec3& v, LimitNorm norm, double limit, double vertical) {
  switch (norm) {
    case LimitNorm::euclidean:
      return v.norm() / limit;
    case LimitNorm::per_axis:
      return v.cwiseAbs().maxCoeff<Eigen::PropagateNaN>() / limit;
    case LimitNorm::horizontal_vertical:
      break;
  }
  double use = v.head<2>().norm() / limit;
  raise(use, std::abs(v.z()) / (vertical > 0.0 ? vertical : limit));
  return use;
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

// How a piece that begins at begin_s uses velocity, acceleration and jerk.
void certify_derivatives(const BezierPiece& piece, double begin_s, const Limits& limits,
                         const StartAllowance& allowance, Certificate& c) {
  // A negative duration would turn the velocity round and keep its length.
  if (!(piece.duration_s > 0.0) || !limits.check().ok()) {
    c.velocity_m_s = c.acceleration_m_s2 = c.jerk_m_s3 = kNaN;
    return;
  }
  const double v =
      largest_use(piece.velocity_points(), [&](const Vec3& p) { return limits.speed_usage(p); });
  const double a = largest_use(piece.acceleration_points(),
                               [&](const Vec3& p) { return limits.acceleration_usage(p); });
  const bool early = begin_s < allowance.until_s;
  raise(c.velocity_m_s, (v - (early ? allowance.speed : 1.0)) * limits.v_max_m_s);
  raise(c.acceleration_m_s2, (a - (early ? allowance.acceleration : 1.0)) * limits.a_max_m_s2);
  if (limits.j_max_m_s3 > 0.0) {
    const double jerk = largest_use(piece.jerk_points(), [](const Vec3& p) { return p.norm(); });
    raise(c.jerk_m_s3, jerk - limits.j_max_m_s3);
  }
  if (!early) return;
  raise(c.start_excess_m_s, (v - 1.0) * limits.v_max_m_s);
  raise(c.start_excess_m_s2, (a - 1.0) * limits.a_max_m_s2);
  if (v > 1.0 + kNoExcess || a > 1.0 + kNoExcess) c.start_excess_s = begin_s + piece.duration_s;
}

void certify_joint(const BezierPiece& before, const BezierPiece& after, Certificate& c) {
  const auto end = before.sample(before.duration_s);
  const auto begin = after.sample(0.0);
  raise(c.joint_position_m, (end.position - begin.position).norm());
  raise(c.joint_velocity_m_s, (end.velocity - begin.velocity).norm());
  raise(c.joint_acceleration_m_s2, (end.acceleration - begin.acceleration).norm());
}

std::array<std::pair<const char*, double>, 9> families(const Certificate& c) {
  return {{{"position", c.position_m},
           {"velocity", c.velocity_m_s},
           {"acceleration", c.acceleration_m_s2},
           {"joint position", c.joint_position_m},
           {"joint velocity", c.joint_velocity_m_s},
           {"joint acceleration", c.joint_acceleration_m_s2},
           {"start", c.start_m},
           {"goal", c.goal_m},
           {"jerk", c.jerk_m_s3}}};
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
  const auto optional = [&](const char* name, double value) {
    if (value != 0.0) positive(name, value);
  };
  optional("j_max_m_s3", j_max_m_s3);
  optional("v_max_vertical_m_s", v_max_vertical_m_s);
  optional("a_max_vertical_m_s2", a_max_vertical_m_s2);
  if (faults.empty()) return success();
  return fail(ErrorCode::invalid_limits, faults + ": a limit must be finite and above zero");
}

double Limits::speed_usage(const Vec3& velocity) const {
  return norm_of(velocity, norm, v_max_m_s, v_max_vertical_m_s);
}

double Limits::acceleration_usage(const Vec3& acceleration) const {
  return norm_of(acceleration, norm, a_max_m_s2, a_max_vertical_m_s2);
}

StartAllowance StartAllowance::of(const FlatState& start, const Limits& limits) {
  constexpr double kReaction_s = 0.1;
  const double v = limits.speed_usage(start.velocity);
  const double a = limits.acceleration_usage(start.acceleration);
  StartAllowance allowance;
  if (!(v > 1.0 + kNoExcess || a > 1.0 + kNoExcess)) return allowance;
  const double v_to_a_s = limits.v_max_m_s / limits.a_max_m_s2;
  allowance.acceleration = std::max(1.0, a);
  allowance.speed = std::max(1.0, v) + allowance.acceleration * kReaction_s / v_to_a_s;
  allowance.until_s = 2.0 * std::max(0.0, v - 1.0) * v_to_a_s + 0.5;
  return allowance;
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
  if (limits.j_max_m_s3 > 0.0) c.jerk_m_s3 = none;
  const StartAllowance allowance = StartAllowance::of(start, limits);
  const BezierPiece* before = nullptr;
  double begin_s = 0.0;
  for (const auto& piece : trajectory.pieces) {
    if (piece.polytope < 0 || std::size_t(piece.polytope) >= polytopes.size()) {
      throw std::out_of_range("certify(): a piece names polytope " +
                              std::to_string(piece.polytope) + ", which is not there");
    }
    raise(c.position_m, position_violation(piece, polytopes[std::size_t(piece.polytope)]));
    certify_derivatives(piece, begin_s, limits, allowance, c);
    if (before != nullptr) certify_joint(*before, piece, c);
    before = &piece;
    begin_s += piece.duration_s;
  }
  const auto& last = trajectory.pieces.back();
  c.start_m = difference(trajectory.pieces.front().sample(0.0), start);
  c.goal_m = difference(last.sample(last.duration_s), goal);
  return c;
}

}  // namespace goshawk
