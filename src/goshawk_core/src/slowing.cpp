#include "slowing.hpp"

#include <algorithm>
#include <cmath>

namespace goshawk {
namespace {

constexpr double kKnot_s = 0.1;  // longest piece
constexpr double kShortest_s = 1e-3;

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

TimeLaw::At TimeLaw::at(double u) const {
  const double k = slope_ / ramp_s_;
  if (u <= ramp_s_) return {u - k * u * u * u / 6.0, 1.0 - k * u * u / 2.0, -k * u};
  const double left = duration_s() - u;
  if (left <= ramp_s_) {  // the same backwards: from rest
    return {duration_s() / 2.0 - k * left * left * left / 6.0, k * left * left / 2.0, -k * left};
  }
  const double v = u - ramp_s_;
  const double rate = 1.0 - slope_ * ramp_s_ / 2.0;
  const double at_ramp_end = ramp_s_ - slope_ * ramp_s_ * ramp_s_ / 6.0;
  return {at_ramp_end + rate * v - slope_ * v * v / 2.0, rate - slope_ * v, -slope_};
}

double TimeLaw::when(double passed_s) const {
  double low = 0.0, high = duration_s();
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (low + high);
    (at(middle).passed_s < passed_s ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

FlatState SlowedPath::at(const TimeLaw::At& law) const {
  const FlatState path = path_.sample(std::min(from_s_ + law.passed_s, path_.duration_s()));
  return {.position = path.position,
          .velocity = law.rate * path.velocity,
          .acceleration = law.rate * law.rate * path.acceleration + law.rate_1_s * path.velocity};
}

// When pieces end on the way, and the polytope that each is in.
std::vector<SlowedPath::Knot> SlowedPath::knots(const TimeLaw& law, bool cut_at_ramps) const {
  std::vector<Knot> knots;
  const auto add = [&](double begin, double end, int polytope) {
    const int parts = std::max(1, int(std::ceil((end - begin) / kKnot_s)));
    for (int i = 1; i <= parts; ++i) {
      knots.push_back({begin + (end - begin) * i / parts, polytope});
    }
  };
  const double first_cut = law.ramp_s(), second_cut = law.duration_s() - law.ramp_s();
  const double passes_s = law.duration_s() / 2.0;
  double end_s = -from_s_, begin = 0.0;
  for (const BezierPiece& piece : path_.pieces) {
    end_s += piece.duration_s;
    if (end_s <= kShortest_s) continue;
    const bool is_last = end_s >= passes_s - kShortest_s;
    const double end = is_last ? law.duration_s() : law.when(end_s);
    for (const double cut : {first_cut, second_cut}) {
      const bool inside = cut > begin + kShortest_s && cut < end - kShortest_s;
      if (!cut_at_ramps || !inside) continue;
      add(begin, cut, piece.polytope);
      begin = cut;
    }
    add(begin, end, piece.polytope);
    if (is_last) break;
    begin = end;
  }
  return knots;
}

Trajectory SlowedPath::by(const TimeLaw& law, bool cut_at_ramps) const {
  Trajectory trajectory;
  FlatState state = at(law.at(0.0));
  double time_s = 0.0;
  for (const Knot& knot : knots(law, cut_at_ramps)) {
    const FlatState next = at(law.at(knot.time_s));
    trajectory.pieces.push_back(BezierPiece::between(state, next, knot.time_s - time_s));
    trajectory.pieces.back().polytope = knot.polytope;
    state = next;
    time_s = knot.time_s;
  }
  return trajectory;
}

Result<CertifiedTrajectory> certify_slowed(const SlowedPath& path, const TimeLaw& law,
                                           Trajectory slowed, std::vector<Polytope> polytopes,
                                           double from_s, const Limits& limits) {
  auto used = keep_used(std::move(polytopes), from_s, slowed);
  FlatState end = path.at(law.at(law.duration_s()));
  end.velocity.setZero();
  end.acceleration.setZero();
  return certify(std::move(slowed), std::move(used), limits, path.start(), end);
}

}  // namespace goshawk
