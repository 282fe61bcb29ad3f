#include "goshawk/trajectory_optimizer/plan.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "cut.hpp"
#include "goshawk/trajectory_optimizer/time_profile.hpp"

namespace goshawk::trajectory_optimizer {
namespace {

constexpr double kLeastLength = 1e-6;  // [m] of a path, for the estimate of its duration
constexpr double kShortest = 0.01;     // of a mean piece: shorter ones cost accuracy

constexpr double kCorner = 0.6;  // of v^2 / a: how far a corner is cut, generously

double speed_along(const FlatState& state, const Vec3& from, const Vec3& to) {
  const Vec3 step = to - from;
  return step.norm() > 0.0 ? std::max(0.0, state.velocity.dot(step) / step.norm()) : 0.0;
}

double path_length(const std::vector<Vec3>& waypoints) {
  double length = 0.0;
  for (std::size_t k = 0; k + 1 < waypoints.size(); ++k) {
    length += (waypoints[k + 1] - waypoints[k]).norm();
  }
  return length;
}

}  // namespace

bool Request::rests() const {
  return !is_moving(start) && !is_moving(goal);
}

double Plan::duration_s() const {
  return std::accumulate(durations_s.begin(), durations_s.end(), 0.0);
}

Plan cut_trapezoid(const Request& request, const Config& config, const Lead& lead) {
  const auto& waypoints = request.corridor.waypoints_map;
  const std::size_t n = waypoints.size() - 1;
  const TimeProfile profile(waypoints, request.limits,
                            speed_along(request.start, waypoints[0], waypoints[1]),
                            speed_along(request.goal, waypoints[n - 1], waypoints[n]));
  Plan plan;
  plan.stays = request.rests() && path_length(waypoints) <= kLeastLength;
  plan.reference_s = plan.stays ? config.piece_duration_s : profile.duration_s();
  plan.reference_s = std::max(
      plan.reference_s,
      rest_to_rest_duration_s(kLeastLength, request.limits.v_max_m_s, request.limits.a_max_m_s2));
  plan.at_moving_end = lead.first_piece;
  const auto cutter = Cutter::of(request, config, plan.reference_s, plan.at_moving_end);
  double begin = 0.0;
  plan.joints.push_back(request.start);
  for (int k = 0; k < profile.segments(); ++k) {
    const double trapezoid =
        plan.stays ? plan.reference_s / profile.segments() : profile.duration_s(k);
    const double stretch = k == 0 ? lead.first_segment : 1.0;
    const double duration = stretch * trapezoid;
    cutter.cut(begin, duration, [&](double t, double piece) {
      append(plan, std::max(piece, kShortest * cutter.longest_s), k,
             profile.state(k, std::min(t / stretch, trapezoid)));
    });
    begin += duration;
  }
  plan.joints.back() = request.goal;
  plan.braking_s = lead.braking * StartAllowance::of(request.start, request.limits).until_s;
  return plan;
}

Plan thesis_plan(const Request& request) {
  const auto& waypoints = request.corridor.waypoints_map;
  Plan plan;
  plan.joints.push_back(request.start);
  for (std::size_t k = 0; k + 1 < waypoints.size(); ++k) {
    const double length = std::max((waypoints[k + 1] - waypoints[k]).norm(), kLeastLength);
    FlatState end;
    end.position = waypoints[k + 1];
    append(plan,
           rest_to_rest_duration_s(length, request.limits.v_max_m_s, request.limits.a_max_m_s2),
           int(k), end);
  }
  plan.joints.back() = request.goal;
  plan.reference_s = plan.duration_s();
  return plan;
}

namespace {

Joint to_units(const FlatState& state, const Units& units) {
  Joint joint;
  joint.col(0) = (state.position - units.origin_map) / units.length_m;
  joint.col(1) = state.velocity * (units.time_s / units.length_m);
  joint.col(2) = state.acceleration * (units.time_s * units.time_s / units.length_m);
  return joint;
}

// Adds the faces that control point j of piece k must stay behind.
class FaceWriter {
 public:
  FaceWriter(const Request& request, const Plan& plan, const Units& units, double reach_m,
             SplineProblem& problem)
      : request_(request), plan_(plan), units_(units), reach_m_(reach_m), problem_(problem) {}

  // @return false where the point is constant and outside
  bool add(int piece, int j) {
    const int joint = j < 3 ? piece : piece + 1;
    const PointMap map = position_point(j, problem_.durations[std::size_t(piece)]);
    const Polytope& polytope =
        request_.corridor.polytopes[std::size_t(plan_.polytopes[std::size_t(piece)])];
    const Vec3 coefficients = j < 3 ? map.from_first : map.from_second;
    const bool end = joint == 0 || joint == problem_.pieces();
    if (end) return add_at_end(joint, coefficients, polytope);
    const int begin = int(problem_.faces.size());
    const Vec3 near = problem_.joints[std::size_t(joint)] * coefficients;
    for (int i = 0; i < polytope.faces(); ++i) {
      const Vec3& normal = polytope.half_spaces[std::size_t(i)].normal;
      const double bound = offset(polytope, i);
      if ((bound - normal.dot(near)) * units_.length_m <= reach_m_)
        problem_.faces.push_back({normal, bound});
    }
    finish(joint, coefficients, begin);
    return true;
  }

 private:
  double offset(const Polytope& polytope, int i) const {
    const HalfSpace& face = polytope.half_spaces[std::size_t(i)];
    return (face.offset_m - face.normal.dot(units_.origin_map)) / units_.length_m;
  }

  void finish(int joint, const Vec3& coefficients, int begin) {
    const int end = int(problem_.faces.size());
    if (end > begin) problem_.face_points.push_back({joint, coefficients, begin, end});
  }

  // An end moves with the time scale only. Faces that it moves away from need no constraint.
  bool add_at_end(int joint, const Vec3& coefficients, const Polytope& polytope) {
    const Joint& x = problem_.joints[std::size_t(joint)];
    const Joint& rate = joint == 0 ? problem_.start_rate : problem_.goal_rate;
    const Vec3 y = x * coefficients;
    const bool moves = problem_.scale && !rate.isZero(0.0);
    const int begin = int(problem_.faces.size());
    for (int i = 0; i < polytope.faces(); ++i) {
      const Vec3& normal = polytope.half_spaces[std::size_t(i)].normal;
      const double tolerance = 0.5e-6 / units_.length_m;  // half of the certificate's
      const double bound = std::max(offset(polytope, i), normal.dot(x.col(0))) + tolerance;
      if (!moves && normal.dot(y) > bound) return false;
      const bool departs = coefficients[1] * normal.dot(x.col(1)) <= 0.0 &&
                           coefficients[2] * normal.dot(x.col(2)) <= 0.0;
      if (moves && !departs) problem_.faces.push_back({normal, bound});
    }
    finish(joint, coefficients, begin);
    return true;
  }

  const Request& request_;
  const Plan& plan_;
  const Units& units_;
  const double reach_m_;
  SplineProblem& problem_;
};

}  // namespace

double corner_reach_m(const Plan& plan, const Limits& limits) {
  const double v = limits.v_max_m_s;
  return kCorner * std::min(v * v / limits.a_max_m_s2, 0.5 * v * plan.reference_s);
}

double natural_jerk(const Plan& plan, const Limits& limits) {
  const double ramp_s = std::min(limits.v_max_m_s / limits.a_max_m_s2, 0.5 * plan.reference_s);
  return limits.a_max_m_s2 / ramp_s;
}

namespace {

double over_vertical(double limit, double vertical) {
  return vertical > 0.0 ? limit / vertical : 1.0;
}

// Pieces that begin while a start above a limit is braked may be as fast as it.
void allow_for_start(const Request& request, const Plan& plan, SplineProblem& problem) {
  const StartAllowance allowance = StartAllowance::of(request.start, request.limits);
  double begin = 0.0;
  for (std::size_t k = 0; k < plan.durations_s.size(); ++k) {
    if (begin >= std::min(plan.braking_s, allowance.until_s)) break;
    problem.v_max[k] *= allowance.speed;
    problem.a_max[k] *= allowance.acceleration;
    begin += plan.durations_s[k];
  }
}

}  // namespace

bool make_problem(const Request& request, const Plan& plan, bool scale, double time_weight,
                  double reach_m, SplineProblem& problem, Units& units, double end_slack) {
  const std::size_t m = plan.durations_s.size();
  const Limits& limits = request.limits;
  units.origin_map = request.start.position;
  units.time_s = plan.duration_s() / double(m);
  units.length_m = limits.v_max_m_s * units.time_s;
  const double tighten = 1.0 - 1e-9;  // rounding must not cost the certificate

  problem.clear();
  problem.scale = scale;
  problem.norm = limits.norm;
  problem.time_weight = 1.0;
  // Mean squared jerk in natural units; the problem has one half before it.
  const double jerk_unit = units.length_m / std::pow(units.time_s, 3);
  problem.jerk_weight =
      2.0 * std::pow(jerk_unit / natural_jerk(plan, limits), 2) / double(m) / time_weight;
  for (const double duration : plan.durations_s) {
    problem.durations.push_back(duration / units.time_s);
  }
  problem.v_max.assign(m, tighten);
  problem.a_max.assign(m, tighten * limits.a_max_m_s2 * units.time_s / limits.v_max_m_s);
  if (limits.j_max_m_s3 > 0.0) {
    problem.j_max.assign(
        m, tighten * limits.j_max_m_s3 * units.time_s * units.time_s / limits.v_max_m_s);
  }
  problem.v_over_vertical = over_vertical(limits.v_max_m_s, limits.v_max_vertical_m_s);
  problem.a_over_vertical = over_vertical(limits.a_max_m_s2, limits.a_max_vertical_m_s2);
  for (std::size_t k = 0; k < m; ++k) problem.a_max[k] *= plan.a_factor(k);
  allow_for_start(request, plan, problem);
  // A start or goal may lie on a limit: half of the certificate's tolerance gives it an interior.
  const auto loosen = [&](std::size_t piece) {
    problem.v_max[piece] += 0.5e-6 / limits.v_max_m_s + end_slack;
    problem.a_max[piece] += 0.5e-6 * units.time_s / limits.v_max_m_s;
  };
  if (is_moving(request.start)) loosen(0);
  if (is_moving(request.goal)) loosen(m - 1);
  for (const FlatState& joint : plan.joints) problem.joints.push_back(to_units(joint, units));
  if (scale) {  // v' = v sqrt(eta), a' = a eta
    const auto rate = [](const Joint& x) {
      Joint r = Joint::Zero();
      r.col(1) = 0.5 * x.col(1);
      r.col(2) = x.col(2);
      return r;
    };
    problem.start_rate = rate(problem.joints.front());
    problem.goal_rate = rate(problem.joints.back());
  }
  FaceWriter faces(request, plan, units, reach_m, problem);
  bool inside = true;
  for (int k = 0; k < int(m); ++k) {
    const bool enters =
        k > 0 && plan.polytopes[std::size_t(k)] != plan.polytopes[std::size_t(k) - 1];
    for (int j = enters ? 0 : 1; j <= (k + 1 < int(m) ? 5 : 4); ++j) {
      inside = faces.add(k, j) && inside;
    }
  }
  return inside;
}

void take_solution(const Request& request, const std::vector<Joint>& joints, const Units& units,
                   double kappa, Plan& plan) {
  const double time = units.time_s * kappa;
  for (double& duration : plan.durations_s) duration *= kappa;
  for (std::size_t k = 1; k + 1 < joints.size(); ++k) {
    FlatState& state = plan.joints[k];
    state.position = units.origin_map + units.length_m * joints[k].col(0);
    state.velocity = (units.length_m / time) * joints[k].col(1);
    state.acceleration = (units.length_m / (time * time)) * joints[k].col(2);
  }
  plan.joints.front() = request.start;
  plan.joints.back() = request.goal;
}

Trajectory make_trajectory(const Plan& plan) {
  Trajectory trajectory;
  trajectory.pieces.reserve(plan.durations_s.size());
  for (std::size_t k = 0; k < plan.durations_s.size(); ++k) {
    trajectory.pieces.push_back(
        BezierPiece::between(plan.joints[k], plan.joints[k + 1], plan.durations_s[k]));
    trajectory.pieces.back().polytope = plan.polytopes[k];
  }
  return trajectory;
}

}  // namespace goshawk::trajectory_optimizer
