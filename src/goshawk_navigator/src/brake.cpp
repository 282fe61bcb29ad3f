#include "goshawk/navigator/brake.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace goshawk::navigator {
namespace {

constexpr double kRamp_s = 0.3;     // of the deceleration, to its full value and back
constexpr double kKnot_s = 0.1;     // longest piece: the quintics then leave the path by some 0.1 um
constexpr double kShortest_s = 1e-3;
constexpr std::array kSlower{1.0, 1.25, 1.6, 2.0, 2.5, 3.2, 4.0, 5.0};

/// How fast the path's own time passes, and how far it has come, over real time since the start of
/// braking. The rate goes from one to zero.
class TimeLaw {
 public:
  /// @param fall_s how long the rate would take to fall at its fastest
  explicit TimeLaw(double fall_s)
      : ramp_s_(std::min(kRamp_s, fall_s)), plateau_s_(fall_s - ramp_s_), slope_(1.0 / fall_s) {}

  double duration_s() const { return plateau_s_ + 2.0 * ramp_s_; }

  struct At {
    double passed_s;   // of the path's time
    double rate;
    double rate_1_s;   // its derivative
  };
  At at(double u) const {
    if (u <= ramp_s_) {
      const double k = slope_ / ramp_s_;
      return {u - k * u * u * u / 6.0, 1.0 - k * u * u / 2.0, -k * u};
    }
    const double left = duration_s() - u;
    if (left <= ramp_s_) {  // the same backwards: from rest
      const double k = slope_ / ramp_s_;
      return {duration_s() / 2.0 - k * left * left * left / 6.0, k * left * left / 2.0, -k * left};
    }
    const double v = u - ramp_s_;
    const double rate = 1.0 - slope_ * ramp_s_ / 2.0;
    return {at_ramp_end() + rate * v - slope_ * v * v / 2.0, rate - slope_ * v, -slope_};
  }
  /// When so much of the path's time has passed. @param passed_s in [0, duration_s() / 2]
  double when(double passed_s) const {
    double low = 0.0, high = duration_s();
    for (int i = 0; i < 60; ++i) {
      const double middle = 0.5 * (low + high);
      (at(middle).passed_s < passed_s ? low : high) = middle;
    }
    return 0.5 * (low + high);
  }

 private:
  double at_ramp_end() const { return ramp_s_ - slope_ * ramp_s_ * ramp_s_ / 6.0; }

  double ramp_s_;
  double plateau_s_;
  double slope_;  // [1/s] of the rate, at its steepest
};

/// The path that is braked along, from a moment on.
class Path {
 public:
  Path(const CommittedTrajectory& committed, double from_s)
      : flown_(committed.flown()), from_s_(from_s) {}

  double left_s() const { return flown_.duration_s() - from_s_; }

  FlatState at(const TimeLaw::At& law) const {
    const FlatState path = flown_.sample(std::min(from_s_ + law.passed_s, flown_.duration_s()));
    return {.position = path.position,
            .velocity = law.rate * path.velocity,
            .acceleration = law.rate * law.rate * path.acceleration + law.rate_1_s * path.velocity};
  }

  /// When pieces end on the way, and the polytope that each is in.
  struct Knot {
    double time_s;
    int polytope;
  };
  std::vector<Knot> knots(const TimeLaw& law) const {
    std::vector<Knot> knots;
    const double passes_s = law.duration_s() / 2.0;
    double end_s = -from_s_, begin = 0.0;
    for (const BezierPiece& piece : flown_.pieces) {
      end_s += piece.duration_s;
      if (end_s <= kShortest_s) continue;
      const bool is_last = end_s >= passes_s - kShortest_s;
      const double end = is_last ? law.duration_s() : law.when(end_s);
      const int parts = std::max(1, int(std::ceil((end - begin) / kKnot_s)));
      for (int i = 1; i <= parts; ++i) {
        knots.push_back({begin + (end - begin) * i / parts, piece.polytope});
      }
      if (is_last) break;
      begin = end;
    }
    return knots;
  }

 private:
  const Trajectory& flown_;
  double from_s_;
};

Trajectory slowed(const Path& path, const TimeLaw& law) {
  Trajectory trajectory;
  FlatState state = path.at(law.at(0.0));
  double time_s = 0.0;
  for (const auto& knot : path.knots(law)) {
    const FlatState next = path.at(law.at(knot.time_s));
    trajectory.pieces.push_back(BezierPiece::between(state, next, knot.time_s - time_s));
    trajectory.pieces.back().polytope = knot.polytope;
    state = next;
    time_s = knot.time_s;
  }
  return trajectory;
}

/// Those that the trajectory is in, their intervals counted from from_s on.
std::vector<Polytope> keep_used(std::vector<Polytope> polytopes, double from_s,
                                Trajectory& trajectory) {
  std::vector<Polytope> used;
  std::vector<int> number(polytopes.size(), -1);
  for (BezierPiece& piece : trajectory.pieces) {
    int& k = number[std::size_t(piece.polytope)];
    if (k < 0) {
      k = int(used.size());
      used.push_back(std::move(polytopes[std::size_t(piece.polytope)]));
      if (!used.back().always_valid()) {
        used.back().valid_from_s -= from_s;
        used.back().valid_until_s -= from_s;
      }
    }
    piece.polytope = k;
  }
  return used;
}

}  // namespace

Result<CertifiedTrajectory> brake_along(const CommittedTrajectory& committed, double from_s,
                                        const std::function<bool(const Trajectory&)>& is_free) {
  const Path path(committed, from_s);
  const Limits& limits = committed.nominal().limits();
  const FlatState start = path.at({0.0, 1.0, 0.0});
  const double gentle_s = std::max(kRamp_s, start.velocity.norm() / limits.a_max_m_s2);
  for (const double slower : kSlower) {
    const TimeLaw law(slower * gentle_s);
    if (law.duration_s() / 2.0 >= path.left_s()) break;
    Trajectory trajectory = slowed(path, law);
    if (!is_free(trajectory)) continue;
    auto polytopes = keep_used(committed.flown_polytopes(), from_s, trajectory);
    FlatState end = path.at(law.at(law.duration_s()));
    end.velocity.setZero();
    end.acceleration.setZero();
    auto certified = certify(std::move(trajectory), std::move(polytopes), limits, start, end);
    if (certified) return certified;
  }
  return fail(ErrorCode::trajectory_infeasible,
              fmt::format("trajectory {} cannot be braked along its path {:.3g} s after its start: "
                          "it ends as soon by itself, or is at its limits there",
                          committed.id(), from_s));
}

}  // namespace goshawk::navigator
