#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "bezier_basis.hpp"
#include "goshawk/guard/curve.hpp"

namespace goshawk::guard {
namespace {

Status check_samples(const std::vector<Sample>& samples) {
  const auto wrong = [](const std::string& why) { return fail(ErrorCode::invalid_input, why); };
  if (samples.size() < 2 || samples.size() > kMostPoints) {
    return wrong(fmt::format("the plan has {} points with times; 2 to {} are allowed",
                             samples.size(), kMostPoints));
  }
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const Sample& s = samples[i];
    const bool is_number = std::isfinite(s.t_s) && (!s.velocity || s.velocity->allFinite()) &&
                           (!s.acceleration || s.acceleration->allFinite());
    if (!is_number || !is_within_reach(s.position)) {
      return wrong(fmt::format("point {} is not finite, or beyond {:g} km", i, 1e-3 * kFarthest_m));
    }
    if (i > 0 && !(s.t_s > samples[i - 1].t_s)) {
      return wrong(fmt::format("time does not grow at point {}: {:.6g} s after {:.6g} s", i, s.t_s,
                               samples[i - 1].t_s));
    }
  }
  return success();
}

/// Samples with time between them, the first and the last among them. @param off_m how far what is
/// left out is from the polyline through what stays
std::vector<Sample> thinned(const std::vector<Sample>& samples, double& off_m) {
  // Stamps of messages are cut to nanoseconds.
  constexpr double kStep_s = kShortestPiece_s * (1.0 - 1e-3);
  std::vector<Sample> kept{samples.front()};
  std::size_t last = 0;
  for (std::size_t i = 1; i < samples.size(); ++i) {
    const bool is_end = i + 1 == samples.size();
    const bool is_close = samples[i].t_s - samples[last].t_s < kStep_s ||
                          samples.back().t_s - samples[i].t_s < kLeastPiece_s;
    if (is_close && !is_end) continue;
    for (std::size_t j = last + 1; j < i; ++j) {
      off_m = std::max(off_m, distance_to_segment(samples[j].position, samples[last].position,
                                                  samples[i].position));
    }
    kept.push_back(samples[i]);
    last = i;
  }
  return kept;
}

std::vector<FlatState> states_of(const std::vector<Sample>& samples) {
  const std::size_t n = samples.size();
  const bool with_accelerations =
      std::ranges::all_of(samples, [](const Sample& s) { return s.acceleration.has_value(); });
  std::vector<FlatState> states(n);
  for (std::size_t i = 0; i < n; ++i) {
    states[i].position = samples[i].position;
    states[i].velocity = *samples[i].velocity;
    const Sample& before = samples[i > 0 ? i - 1 : 0];
    const Sample& after = samples[std::min(i + 1, n - 1)];
    states[i].acceleration =
        with_accelerations ? *samples[i].acceleration
                           : Vec3((*after.velocity - *before.velocity) / (after.t_s - before.t_s));
  }
  // A plan that ends without speed ends at rest.
  if (!with_accelerations && states[n - 1].velocity.norm() < 1e-3) {
    states[n - 1].acceleration.setZero();
  }
  if (!with_accelerations && states[0].velocity.norm() < 1e-3) states[0].acceleration.setZero();
  return states;
}

/// Slopes of the cubic spline with continuous acceleration: none of that at its start, at rest at
/// its end (de Boor, "A Practical Guide to Splines", chapter IV; Thomas' algorithm).
std::vector<Vec3> slopes_of(const std::vector<Sample>& s) {
  const std::size_t n = s.size();
  std::vector<double> upper(n, 0.0);
  std::vector<Vec3> slopes(n, Vec3::Zero());
  const auto step = [&](std::size_t i) { return s[i + 1].t_s - s[i].t_s; };
  const auto rise = [&](std::size_t i) { return Vec3(s[i + 1].position - s[i].position); };
  upper[0] = 0.5;
  slopes[0] = 1.5 * rise(0) / step(0);
  for (std::size_t i = 1; i + 1 < n; ++i) {
    const double before = 1.0 / step(i - 1), after = 1.0 / step(i);
    const double pivot = 2.0 * (before + after) - before * upper[i - 1];
    upper[i] = after / pivot;
    const Vec3 right =
        3.0 * (before * before * rise(i - 1) + after * after * rise(i)) - before * slopes[i - 1];
    slopes[i] = right / pivot;
  }
  slopes[n - 1].setZero();
  for (std::size_t i = n - 1; i-- > 0;) slopes[i] -= upper[i] * slopes[i + 1];
  return slopes;
}

}  // namespace

Result<Curve> curve_of(const Samples& plan) {
  if (auto status = check_samples(plan.samples); !status) return status.error();
  Curve curve;
  double left_out_m = 0.0, off_m = 0.0;
  const auto samples = thinned(plan.samples, left_out_m);
  if (samples.size() > kMostPieces + 1) {
    return fail(
        ErrorCode::invalid_input,
        fmt::format("the plan lasts {:.3g} s in {} steps; {} are allowed: send the part "
                    "that is flown next",
                    samples.back().t_s - samples.front().t_s, samples.size() - 1, kMostPieces));
  }
  const bool moves =
      std::ranges::all_of(samples, [](const Sample& s) { return s.velocity.has_value(); });
  const auto states = moves ? states_of(samples) : std::vector<FlatState>();
  const auto slopes = moves ? std::vector<Vec3>() : slopes_of(samples);
  for (std::size_t i = 0; i + 1 < samples.size(); ++i) {
    const Vec3 &a = samples[i].position, &b = samples[i + 1].position;
    const double step_s = samples[i + 1].t_s - samples[i].t_s;
    curve.trajectory.pieces.push_back(
        moves ? BezierPiece::between(states[i], states[i + 1], step_s)
              : quintic({a, a + step_s / 3.0 * slopes[i], b - step_s / 3.0 * slopes[i + 1], b},
                        step_s));
    const BezierPiece& piece = curve.trajectory.pieces.back();
    for (int k = 0; k < 6; ++k) {
      if (is_within_reach(piece.control_points.col(k))) continue;
      return fail(ErrorCode::invalid_input,
                  fmt::format("the velocities lead beyond {:g} km, {:.3g} s after the start",
                              1e-3 * kFarthest_m, samples[i].t_s - samples.front().t_s));
    }
    off_m = std::max(off_m, hull_distance(piece, a, b));
  }
  curve.deviation_m = left_out_m + off_m;
  return curve;
}

}  // namespace goshawk::guard
