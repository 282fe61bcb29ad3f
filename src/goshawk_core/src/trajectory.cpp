#include "goshawk/core/trajectory.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

namespace goshawk {
namespace {

// De Casteljau: stable, and inside the hull even in floating point.
template <int N>
Vec3 bezier(Points3<N> points, double tau) {
  for (int level = N - 1; level > 0; --level) {
    for (int i = 0; i < level; ++i) {
      points.col(i) = (1.0 - tau) * points.col(i) + tau * points.col(i + 1);
    }
  }
  return points.col(0);
}

}  // namespace

double largest_difference(const FlatState& a, const FlatState& b) {
  double worst = (a.position - b.position).norm();
  for (const double d :
       {(a.velocity - b.velocity).norm(), (a.acceleration - b.acceleration).norm()}) {
    if (d > worst || std::isnan(d)) worst = d;
  }
  return worst;
}

Points3<5> BezierPiece::velocity_points() const {
  return 5.0 / duration_s * (control_points.rightCols<5>() - control_points.leftCols<5>());
}

Points3<4> BezierPiece::acceleration_points() const {
  const auto v = velocity_points();
  return 4.0 / duration_s * (v.rightCols<4>() - v.leftCols<4>());
}

Points3<3> BezierPiece::jerk_points() const {
  const auto a = acceleration_points();
  return 3.0 / duration_s * (a.rightCols<3>() - a.leftCols<3>());
}

FlatState BezierPiece::sample(double t_s) const {
  const double tau = t_s / duration_s;
  return {bezier<6>(control_points, tau), bezier<5>(velocity_points(), tau),
          bezier<4>(acceleration_points(), tau), bezier<3>(jerk_points(), tau)};
}

BezierPiece BezierPiece::until(double t_s) const {
  const double tau = t_s / duration_s;
  BezierPiece head = *this;
  head.duration_s = t_s;
  Points3<6> points = control_points;
  for (int level = 5; level > 0; --level) {
    for (int i = 0; i < level; ++i) {
      points.col(i) = (1.0 - tau) * points.col(i) + tau * points.col(i + 1);
    }
    head.control_points.col(6 - level) = points.col(0);
  }
  return head;
}

BezierPiece BezierPiece::between(const FlatState& start, const FlatState& end, double duration_s) {
  const double T = duration_s;
  BezierPiece piece;
  piece.duration_s = T;
  auto& c = piece.control_points;
  c.col(0) = start.position;
  c.col(1) = start.position + T / 5.0 * start.velocity;
  c.col(2) = start.position + 2.0 * T / 5.0 * start.velocity + T * T / 20.0 * start.acceleration;
  c.col(3) = end.position - 2.0 * T / 5.0 * end.velocity + T * T / 20.0 * end.acceleration;
  c.col(4) = end.position - T / 5.0 * end.velocity;
  c.col(5) = end.position;
  return piece;
}

double Trajectory::duration_s() const {
  double total = 0.0;
  for (const auto& piece : pieces) total += piece.duration_s;
  return total;
}

double Trajectory::length_m() const {
  constexpr std::array<double, 4> x{0.1834346424956498, 0.5255324099163290, 0.7966664774136267,
                                    0.9602898564975363};
  constexpr std::array<double, 4> w{0.3626837833783620, 0.3137066458778873, 0.2223810344533745,
                                    0.1012285362903763};
  double length = 0.0;
  for (const auto& piece : pieces) {
    const double half = piece.duration_s / 2.0;
    for (std::size_t i = 0; i < x.size(); ++i) {
      length += half * w[i] *
                (piece.sample(half * (1.0 - x[i])).velocity.norm() +
                 piece.sample(half * (1.0 + x[i])).velocity.norm());
    }
  }
  return length;
}

double Trajectory::jerk_cost() const {
  // The jerk of a quintic is a quadratic Bezier curve: its square integrates exactly with
  // G_ij = C(2,i) C(2,j) / (5 C(4,i+j)) (method.md).
  Eigen::Matrix3d G;
  G << 6.0, 3.0, 1.0, 3.0, 4.0, 3.0, 1.0, 3.0, 6.0;
  double cost = 0.0;
  for (const auto& piece : pieces) {
    const Eigen::Matrix3d j = piece.jerk_points();
    cost += piece.duration_s / 30.0 * (j.transpose() * j).cwiseProduct(G).sum();
  }
  return cost;
}

FlatState Trajectory::sample(double t_s) const {
  if (pieces.empty()) throw std::logic_error("Trajectory::sample of no pieces");
  const double slack = 1e-9;
  if (!(t_s >= -slack)) throw std::out_of_range("Trajectory::sample before the start");
  double begin = 0.0;
  for (const auto& piece : pieces) {
    if (t_s <= begin + piece.duration_s) return piece.sample(std::max(0.0, t_s - begin));
    begin += piece.duration_s;
  }
  if (t_s > begin + slack) throw std::out_of_range("Trajectory::sample after the end");
  return pieces.back().sample(pieces.back().duration_s);
}

Trajectory Trajectory::until(double t_s) const {
  // Shorter than this a last piece would be rounding alone.
  constexpr double kShortest_s = 1e-9;
  if (!(t_s > 0.0)) throw std::out_of_range("Trajectory::until a time before the start");
  Trajectory head;
  double begin = 0.0;
  for (const auto& piece : pieces) {
    const double rest = t_s - begin;
    if (rest <= kShortest_s && !head.pieces.empty()) return head;
    if (rest < piece.duration_s) {
      head.pieces.push_back(piece.until(rest));
      return head;
    }
    head.pieces.push_back(piece);
    begin += piece.duration_s;
  }
  if (t_s > begin + kShortest_s) throw std::out_of_range("Trajectory::until a time after the end");
  return head;
}

Trajectory::Peaks Trajectory::peaks(int samples_per_piece) const {
  if (samples_per_piece < 1) throw std::invalid_argument("Trajectory::peaks of no samples");
  // Written so that NaN stays: a curve of NaN is not one at rest.
  const auto raise = [](double& peak, double value) {
    if (!std::isnan(peak) && !(value <= peak)) peak = value;
  };
  Peaks peaks;
  for (const auto& piece : pieces) {
    for (int i = 0; i <= samples_per_piece; ++i) {
      const auto state = piece.sample(piece.duration_s * i / samples_per_piece);
      raise(peaks.speed_m_s, state.velocity.norm());
      raise(peaks.acceleration_m_s2, state.acceleration.norm());
    }
  }
  return peaks;
}

Status Trajectory::check() const {
  if (pieces.empty()) return fail(ErrorCode::invalid_input, "the trajectory has no piece");
  for (std::size_t k = 0; k < pieces.size(); ++k) {
    if (!pieces[k].control_points.allFinite()) {
      return fail(ErrorCode::invalid_input,
                  fmt::format("piece {} has a control point that is not finite", k));
    }
    if (!(std::isfinite(pieces[k].duration_s) && pieces[k].duration_s > 0.0)) {
      return fail(ErrorCode::invalid_input,
                  fmt::format("piece {} lasts {:.3g} s: a duration must be finite and above zero",
                              k, pieces[k].duration_s));
    }
  }
  return success();
}

}  // namespace goshawk
