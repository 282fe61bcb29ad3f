#include "goshawk/core/certificate.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>

namespace goshawk {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

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

double position_violation(const BezierPiece& piece, const Polytope& polytope) {
  if (!polytope.check()) return kNaN;
  double worst = polytope.violation(piece.control_points.col(0));
  for (int j = 1; j < 6; ++j) raise(worst, polytope.violation(piece.control_points.col(j)));
  return worst;
}

// By how much a piece that begins at begin_s leaves the interval of its polytope.
void measure_validity(const BezierPiece& piece, double begin_s, const Polytope& polytope,
                      Certificate& c) {
  if (polytope.always_valid()) return;
  raise(c.validity_s, polytope.valid_from_s - begin_s);
  raise(c.validity_s, begin_s + piece.duration_s - polytope.valid_until_s);
}

// How a piece that begins at begin_s uses velocity, acceleration and jerk.
void measure_derivatives(const BezierPiece& piece, double begin_s, const Limits& limits,
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
  if (v > 1.0 + kLimitRounding || a > 1.0 + kLimitRounding)
    c.start_excess_s = begin_s + piece.duration_s;
}

void measure_continuity(const BezierPiece& before, const BezierPiece& after, Certificate& c) {
  const auto end = before.sample(before.duration_s);
  const auto begin = after.sample(0.0);
  raise(c.continuity_position_m, (end.position - begin.position).norm());
  raise(c.continuity_velocity_m_s, (end.velocity - begin.velocity).norm());
  raise(c.continuity_acceleration_m_s2, (end.acceleration - begin.acceleration).norm());
}

std::array<std::pair<const char*, double>, 10> families(const Certificate& c) {
  return {{{"position", c.position_m},
           {"validity", c.validity_s},
           {"velocity", c.velocity_m_s},
           {"acceleration", c.acceleration_m_s2},
           {"position continuity", c.continuity_position_m},
           {"velocity continuity", c.continuity_velocity_m_s},
           {"acceleration continuity", c.continuity_acceleration_m_s2},
           {"start", c.start_m},
           {"goal", c.goal_m},
           {"jerk", c.jerk_m_s3}}};
}

}  // namespace

bool Certificate::holds(double tolerance) const {
  // Written so that NaN fails.
  return std::ranges::all_of(families(*this),
                             [&](const auto& family) { return family.second <= tolerance; });
}

std::string Certificate::worst() const {
  const auto all = families(*this);
  const auto& [name, value] = *std::ranges::max_element(
      all, {}, [](const auto& f) { return std::isnan(f.second) ? HUGE_VAL : f.second; });
  return fmt::format("{} is violated by {:.3g}", name, value);
}

Certificate measure(const Trajectory& trajectory, std::span<const Polytope> polytopes,
                    const Limits& limits, const FlatState& start, const FlatState& goal) {
  if (trajectory.pieces.empty()) throw std::logic_error("measure() of no pieces");
  constexpr double none = -std::numeric_limits<double>::infinity();
  Certificate c{.position_m = none, .velocity_m_s = none, .acceleration_m_s2 = none};
  if (limits.j_max_m_s3 > 0.0) c.jerk_m_s3 = none;
  const auto always = [&](const BezierPiece& piece) {
    const auto k = std::size_t(piece.polytope);
    return k >= polytopes.size() || polytopes[k].always_valid();
  };
  if (!std::ranges::all_of(trajectory.pieces, always)) c.validity_s = none;
  const StartAllowance allowance = StartAllowance::of(start, limits);
  const BezierPiece* before = nullptr;
  double begin_s = 0.0;
  for (const auto& piece : trajectory.pieces) {
    if (piece.polytope < 0 || std::size_t(piece.polytope) >= polytopes.size()) {
      throw std::out_of_range(
          fmt::format("measure(): a piece names polytope {}, which is not there", piece.polytope));
    }
    const Polytope& polytope = polytopes[std::size_t(piece.polytope)];
    raise(c.position_m, position_violation(piece, polytope));
    measure_validity(piece, begin_s, polytope, c);
    measure_derivatives(piece, begin_s, limits, allowance, c);
    if (before != nullptr) measure_continuity(*before, piece, c);
    before = &piece;
    begin_s += piece.duration_s;
  }
  const auto& last = trajectory.pieces.back();
  c.start_m = largest_difference(trajectory.pieces.front().sample(0.0), start);
  c.goal_m = largest_difference(last.sample(last.duration_s), goal);
  return c;
}

}  // namespace goshawk
