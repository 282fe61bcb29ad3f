#pragma once

// Checks a trajectory's certificate without trusting, or needing, anything else of Goshawk: one
// header, the standard library, no Eigen. tools/check_certificate.py is the same in Python.
//
// What is proven (docs/trajectories.md): a Bezier curve lies in the convex hull of its control
// points, and so do its derivatives in the hulls of theirs. So it is enough to look at control
// points: inside their polytope, below the limits, continuous, and beginning and ending as asked.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

namespace goshawk_checker {

using Point = std::array<double, 3>;

struct Piece {
  double duration = 0.0;                  // [s]
  std::size_t polytope = 0;               // index
  std::array<Point, 6> control_points{};  // [m]
};
/// {p : A p <= b}, A row after row, normals of length 1.
struct Polytope {
  std::vector<double> normals, offsets;
  double valid_from = 0.0, valid_until = 0.0;  // [s] after the trajectory's start; both 0: always
};
struct State {
  Point position{}, velocity{}, acceleration{};
};
/// norm 0: Euclidean, 1: each component, 2: horizontal and vertical apart. 0 for a jerk limit means
/// none, for a vertical limit the horizontal one.
struct Limits {
  double v_max = 0.0, a_max = 0.0;
  int norm = 0;
  double j_max = 0.0, v_max_vertical = 0.0, a_max_vertical = 0.0;
};

/// Largest violations; a family holds at or below the tolerance; infinite: nonsense.
struct Verdict {
  double position = 0.0, velocity = 0.0, acceleration = 0.0, jerk = 0.0, validity = 0.0;
  double continuity_position = 0.0, continuity_velocity = 0.0, continuity_acceleration = 0.0;
  double start = 0.0, goal = 0.0;

  bool holds(double tolerance = 1e-6) const {
    for (const double v : {position, velocity, acceleration, jerk, validity, continuity_position,
                           continuity_velocity, continuity_acceleration, start, goal}) {
      if (!(v <= tolerance)) return false;
    }
    return true;
  }
};

namespace detail {

inline void raise(double& worst, double value) {
  if (!(value <= worst)) worst = std::isnan(value) ? HUGE_VAL : value;
}
inline Point difference(const Point& a, const Point& b, double factor = 1.0) {
  return {factor * (a[0] - b[0]), factor * (a[1] - b[1]), factor * (a[2] - b[2])};
}
inline double length(const Point& p) {
  return std::sqrt(p[0] * p[0] + p[1] * p[1] + p[2] * p[2]);
}
/// Control points of the derivative.
inline std::vector<Point> derivative(const std::vector<Point>& points, double duration) {
  std::vector<Point> result;
  for (std::size_t j = 0; j + 1 < points.size(); ++j) {
    result.push_back(difference(points[j + 1], points[j], double(points.size() - 1) / duration));
  }
  return result;
}
/// 1 at the limit.
inline double use(const Point& v, int norm, double limit, double vertical) {
  if (norm == 0) return length(v) / limit;
  const double z = std::abs(v[2]);
  if (norm == 1) return std::max({std::abs(v[0]), std::abs(v[1]), z}) / limit;
  return std::max(std::hypot(v[0], v[1]) / limit, z / (vertical > 0.0 ? vertical : limit));
}
inline double largest_use(const std::vector<Point>& points, int norm, double limit,
                          double vertical) {
  double worst = 0.0;
  for (const Point& p : points) {
    if (!std::isfinite(p[0] + p[1] + p[2])) return HUGE_VAL;
    raise(worst, use(p, norm, limit, vertical));
  }
  return worst;
}
inline double outside(const Polytope& polytope, const Point& p) {
  const std::size_t faces = polytope.offsets.size();
  if (faces == 0 || polytope.normals.size() != 3 * faces) return HUGE_VAL;
  double worst = -HUGE_VAL;
  for (std::size_t i = 0; i < faces; ++i) {
    const double* n = &polytope.normals[3 * i];
    if (!(std::abs(length({n[0], n[1], n[2]}) - 1.0) <= 1e-6)) return HUGE_VAL;
    raise(worst, n[0] * p[0] + n[1] * p[1] + n[2] * p[2] - polytope.offsets[i]);
  }
  return worst;
}
inline bool always(const Polytope& p) {
  return p.valid_from == 0.0 && p.valid_until == 0.0;
}
inline double apart(const State& a, const State& b) {
  double worst = length(difference(a.position, b.position));
  raise(worst, length(difference(a.velocity, b.velocity)));
  raise(worst, length(difference(a.acceleration, b.acceleration)));
  return worst;
}
inline bool sound(const Limits& l) {
  const auto positive = [](double x) { return std::isfinite(x) && x > 0.0; };
  const auto optional = [&](double x) { return x == 0.0 || positive(x); };
  return positive(l.v_max) && positive(l.a_max) && optional(l.j_max) &&
         optional(l.v_max_vertical) && optional(l.a_max_vertical) && l.norm >= 0 && l.norm <= 2;
}

/// A start above a limit: how far above it, and until when, the first pieces may be.
struct Allowance {
  double v_factor = 1.0, a_factor = 1.0, until = 0.0;  // [s]
};
inline Allowance allowance(const State& start, const Limits& limits) {
  const double v0 = use(start.velocity, limits.norm, limits.v_max, limits.v_max_vertical);
  const double a0 = use(start.acceleration, limits.norm, limits.a_max, limits.a_max_vertical);
  if (!(v0 > 1.0 + 1e-6 || a0 > 1.0 + 1e-6)) return {};
  const double a_factor = std::max(1.0, a0);
  return {std::max(1.0, v0) + a_factor * 0.1 * limits.a_max / limits.v_max, a_factor,
          2.0 * std::max(0.0, v0 - 1.0) * limits.v_max / limits.a_max + 0.5};
}
struct Derivatives {
  std::vector<Point> velocity, acceleration, jerk;
};
inline void raise_limits(Verdict& v, const Derivatives& d, const Limits& limits, double v_factor,
                         double a_factor) {
  raise(v.velocity,
        limits.v_max *
            (largest_use(d.velocity, limits.norm, limits.v_max, limits.v_max_vertical) - v_factor));
  raise(v.acceleration, limits.a_max * (largest_use(d.acceleration, limits.norm, limits.a_max,
                                                    limits.a_max_vertical) -
                                        a_factor));
  if (limits.j_max > 0.0) {
    raise(v.jerk, limits.j_max * (largest_use(d.jerk, 0, limits.j_max, 0.0) - 1.0));
  }
}
inline void raise_continuity(Verdict& v, const State& before, const State& after) {
  raise(v.continuity_position, length(difference(after.position, before.position)));
  raise(v.continuity_velocity, length(difference(after.velocity, before.velocity)));
  raise(v.continuity_acceleration, length(difference(after.acceleration, before.acceleration)));
}

}  // namespace detail

/// @return what holds; a trajectory without pieces, or with a polytope that is not there, does not
inline Verdict check(const std::vector<Piece>& pieces, const std::vector<Polytope>& polytopes,
                     const Limits& limits, const State& start, const State& goal) {
  using namespace detail;
  Verdict v{-HUGE_VAL, -HUGE_VAL, -HUGE_VAL, limits.j_max > 0.0 ? -HUGE_VAL : 0.0};
  for (const Piece& p : pieces) {
    if (p.polytope < polytopes.size() && !always(polytopes[p.polytope])) v.validity = -HUGE_VAL;
  }
  if (pieces.empty() || !sound(limits)) v.position = v.velocity = v.acceleration = HUGE_VAL;
  const Allowance allowed = allowance(start, limits);
  double begin = 0.0;
  State before;
  for (std::size_t k = 0; k < pieces.size(); ++k) {
    const Piece& piece = pieces[k];
    if (!(piece.duration > 0.0 && std::isfinite(piece.duration)) ||
        piece.polytope >= polytopes.size()) {
      v.position = HUGE_VAL;
      return v;
    }
    const std::vector<Point> points(piece.control_points.begin(), piece.control_points.end());
    Derivatives d{derivative(points, piece.duration), {}, {}};
    d.acceleration = derivative(d.velocity, piece.duration);
    d.jerk = derivative(d.acceleration, piece.duration);
    const Polytope& home = polytopes[piece.polytope];
    for (const Point& p : points) raise(v.position, outside(home, p));
    if (!always(home)) {
      raise(v.validity, home.valid_from - begin);
      raise(v.validity, begin + piece.duration - home.valid_until);
    }
    const bool early = begin < allowed.until;
    raise_limits(v, d, limits, early ? allowed.v_factor : 1.0, early ? allowed.a_factor : 1.0);
    const State first{points.front(), d.velocity.front(), d.acceleration.front()};
    if (k == 0) {
      v.start = apart(first, start);
    } else {
      raise_continuity(v, before, first);
    }
    before = {points.back(), d.velocity.back(), d.acceleration.back()};
    begin += piece.duration;
  }
  raise(v.goal, apart(before, goal));
  return v;
}

/// @param m a goshawk_msgs/BezierTrajectory as the IDL compiler's C++ types give it
template <typename Message>
Verdict check_message(const Message& m) {
  const auto point = [](const auto& p) { return Point{p.x(), p.y(), p.z()}; };
  const auto state = [&](const auto& s) {
    return State{point(s.position()), point(s.velocity()), point(s.acceleration())};
  };
  std::vector<Piece> pieces;
  for (const auto& p : m.pieces()) {
    Piece piece{p.duration(), std::size_t(p.polytope()), {}};
    for (std::size_t j = 0; j < 6; ++j) piece.control_points[j] = point(p.control_points()[j]);
    pieces.push_back(piece);
  }
  std::vector<Polytope> polytopes;
  for (const auto& p : m.polytopes()) {
    polytopes.push_back({p.normals(), p.offsets(), p.valid_from(), p.valid_until()});
  }
  const auto& l = m.request().limits();
  const Limits limits{l.v_max(), l.a_max(),          int(l.norm()),
                      l.j_max(), l.v_max_vertical(), l.a_max_vertical()};
  return check(pieces, polytopes, limits, state(m.request().start()), state(m.request().goal()));
}

}  // namespace goshawk_checker
