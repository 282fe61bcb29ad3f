#include "goshawk/trajectory_optimizer/plan_problem.hpp"

#include <algorithm>
#include <cmath>
#include <span>

#include "cut.hpp"

namespace goshawk::trajectory_optimizer {
namespace {

Knot to_units(const FlatState& state, const Units& units) {
  Knot knot;
  knot.col(0) = (state.position - units.origin_map) / units.length_m;
  knot.col(1) = state.velocity * (units.time_s / units.length_m);
  knot.col(2) = state.acceleration * (units.time_s * units.time_s / units.length_m);
  return knot;
}

// Adds the faces that control points must stay behind.
class FaceWriter {
 public:
  FaceWriter(const Corridor& corridor, const Plan& plan, const Units& units, double reach_m,
             SplineProblem& problem)
      : corridor_(corridor), plan_(plan), units_(units), reach_m_(reach_m), problem_(problem) {}

  /// Of all pieces, each control point once. @return false if a constant point is outside
  bool add_all() {
    bool inside = true;
    const int m = problem_.pieces();
    for (int k = 0; k < m; ++k) {
      const auto i = std::size_t(k);
      const bool enters = k > 0 && plan_.polytopes[i] != plan_.polytopes[i - 1];
      for (int j = enters ? 0 : 1; j <= (k + 1 < m ? 5 : 4); ++j) inside = add(k, j) && inside;
    }
    return inside;
  }

 private:
  // Of control point j of a piece. @return false if it is constant and outside
  bool add(int piece, int j) {
    const int knot = j < 3 ? piece : piece + 1;
    const PointMap map = position_point(j, problem_.durations[std::size_t(piece)]);
    const auto polytope = std::size_t(plan_.polytopes[std::size_t(piece)]);
    const std::span<const HalfSpace> faces = corridor_.polytopes[polytope].half_spaces;
    const Vec3 coefficients = j < 3 ? map.from_first : map.from_second;
    if (knot == 0 || knot == problem_.pieces()) return add_at_end(knot, coefficients, faces);
    const int begin = int(problem_.faces.size());
    const Vec3 near = problem_.knots[std::size_t(knot)] * coefficients;
    for (const HalfSpace& face : faces) {
      const double bound = to_units(face);
      if ((bound - face.normal.dot(near)) * units_.length_m <= reach_m_)
        problem_.faces.push_back({face.normal, bound});
    }
    finish(knot, coefficients, begin);
    return true;
  }

  // An end moves with the time scale only. Faces that it moves away from need no constraint.
  bool add_at_end(int knot, const Vec3& coefficients, std::span<const HalfSpace> faces) {
    const Knot& x = problem_.knots[std::size_t(knot)];
    const Knot& rate = knot == 0 ? problem_.start_rate : problem_.goal_rate;
    const Vec3 y = x * coefficients;
    const bool moves = problem_.scale && !rate.isZero(0.0);
    const int begin = int(problem_.faces.size());
    for (const HalfSpace& face : faces) {
      const Vec3& normal = face.normal;
      const double tolerance = 0.5e-6 / units_.length_m;  // half of the certificate's
      const double bound = std::max(to_units(face), normal.dot(x.col(0))) + tolerance;
      if (!moves && normal.dot(y) > bound) return false;
      const bool departs = coefficients[1] * normal.dot(x.col(1)) <= 0.0 &&
                           coefficients[2] * normal.dot(x.col(2)) <= 0.0;
      if (moves && !departs) problem_.faces.push_back({normal, bound});
    }
    finish(knot, coefficients, begin);
    return true;
  }

  double to_units(const HalfSpace& face) const {
    return (face.offset_m - face.normal.dot(units_.origin_map)) / units_.length_m;
  }

  void finish(int knot, const Vec3& coefficients, int begin) {
    const int end = int(problem_.faces.size());
    if (end > begin) problem_.face_points.push_back({knot, coefficients, begin, end});
  }

  const Corridor& corridor_;
  const Plan& plan_;
  const Units& units_;
  const double reach_m_;
  SplineProblem& problem_;
};

constexpr double kTighten = 1.0 - 1e-9;  // rounding must not cost the certificate

double over_vertical(double limit, double vertical) {
  return vertical > 0.0 ? limit / vertical : 1.0;
}

// Pieces that begin while a start above a limit is braked may be as fast as it.
void allow_for_start(const PlanRequest& request, const Plan& plan, SplineProblem& problem) {
  const StartAllowance allowance = StartAllowance::of(request.start, request.limits);
  double begin = 0.0;
  for (std::size_t k = 0; k < plan.durations_s.size(); ++k) {
    if (begin >= std::min(plan.braking_s, allowance.until_s)) break;
    problem.v_max[k] *= allowance.speed;
    problem.a_max[k] *= allowance.acceleration;
    begin += plan.durations_s[k];
  }
}

// A start or goal may lie on a limit: half of the certificate's tolerance gives it an interior.
void loosen_at_ends(const PlanRequest& request, const Units& units, double end_slack,
                    SplineProblem& problem) {
  const double v_max = request.limits.v_max_m_s;
  const auto loosen = [&](std::size_t piece) {
    problem.v_max[piece] += 0.5e-6 / v_max + end_slack;
    problem.a_max[piece] += 0.5e-6 * units.time_s / v_max;
  };
  if (is_moving(request.start)) loosen(0);
  if (is_moving(request.goal)) loosen(problem.durations.size() - 1);
}

void set_limits(const PlanRequest& request, const Plan& plan, const Units& units,
                SplineProblem& problem) {
  const Limits& limits = request.limits;
  const std::size_t m = plan.durations_s.size();
  problem.norm = limits.norm;
  problem.v_max.assign(m, kTighten);
  problem.a_max.assign(m, kTighten * limits.a_max_m_s2 * units.time_s / limits.v_max_m_s);
  if (limits.j_max_m_s3 > 0.0) {
    problem.j_max.assign(
        m, kTighten * limits.j_max_m_s3 * units.time_s * units.time_s / limits.v_max_m_s);
  }
  problem.v_over_vertical = over_vertical(limits.v_max_m_s, limits.v_max_vertical_m_s);
  problem.a_over_vertical = over_vertical(limits.a_max_m_s2, limits.a_max_vertical_m_s2);
  for (std::size_t k = 0; k < m; ++k) problem.a_max[k] *= plan.a_factor(k);
  allow_for_start(request, plan, problem);
}

// d knot / d eta at eta = 1, as v' = v sqrt(eta) and a' = a eta.
Knot rate_of(const Knot& end) {
  Knot rate = Knot::Zero();
  rate.col(1) = 0.5 * end.col(1);
  rate.col(2) = end.col(2);
  return rate;
}

}  // namespace

bool make_problem(const PlanRequest& request, const Corridor& corridor, const Plan& plan,
                  const ProblemSettings& settings, SplineProblem& problem, Units& units) {
  const double m = double(plan.durations_s.size());
  units.origin_map = request.start.position;
  units.time_s = plan.duration_s() / m;
  units.length_m = request.limits.v_max_m_s * units.time_s;

  problem.clear();
  problem.scale = settings.scale;
  problem.time_weight = 1.0;
  // Mean squared jerk in natural units; the problem has one half before it.
  const double jerk_unit = units.length_m / std::pow(units.time_s, 3);
  problem.jerk_weight = 2.0 * std::pow(jerk_unit / natural_jerk(plan, request.limits), 2) / m /
                        settings.time_weight;
  for (const double duration : plan.durations_s) {
    problem.durations.push_back(duration / units.time_s);
  }
  set_limits(request, plan, units, problem);
  loosen_at_ends(request, units, settings.end_slack, problem);
  for (const FlatState& knot : plan.knots) problem.knots.push_back(to_units(knot, units));
  if (settings.scale) {
    problem.start_rate = rate_of(problem.knots.front());
    problem.goal_rate = rate_of(problem.knots.back());
  }
  return FaceWriter(corridor, plan, units, settings.reach_m, problem).add_all();
}

void take_solution(const PlanRequest& request, const std::vector<Knot>& knots, const Units& units,
                   double kappa, Plan& plan) {
  const double time = units.time_s * kappa;
  for (double& duration : plan.durations_s) duration *= kappa;
  for (std::size_t k = 1; k + 1 < knots.size(); ++k) {
    FlatState& state = plan.knots[k];
    state.position = units.origin_map + units.length_m * knots[k].col(0);
    state.velocity = (units.length_m / time) * knots[k].col(1);
    state.acceleration = (units.length_m / (time * time)) * knots[k].col(2);
  }
  plan.knots.front() = request.start;
  plan.knots.back() = request.goal;
}

}  // namespace goshawk::trajectory_optimizer
