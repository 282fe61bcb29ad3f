#include "goshawk/flight_check/planned_track.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace goshawk::flight_check {

namespace {

constexpr double kGravity = 9.80665;  // [m/s^2]
constexpr double kMostSamples = 1e7;

struct Moved {
  Vec3 position_map;
  Vec3 acceleration_map;
};

/// De Casteljau: the triangle of averages; its third row from the top gives the curvature.
Moved evaluate(const PlannedPiece& piece, double u) {
  auto p = piece.control_points_map;
  Vec3 second = Vec3::Zero();
  for (int left = 5; left > 0; --left) {
    if (left == 2) second = p[2] - 2.0 * p[1] + p[0];
    for (int i = 0; i < left; ++i)
      p[std::size_t(i)] += u * (p[std::size_t(i) + 1] - p[std::size_t(i)]);
  }
  return {p[0], 20.0 * second / (piece.duration_s * piece.duration_s)};
}

std::string piece_fault(const PlannedPiece& piece) {
  if (!(piece.duration_s > 0.0) || !std::isfinite(piece.duration_s)) {
    return "has a duration that is not above zero";
  }
  for (const Vec3& p : piece.control_points_map) {
    if (!p.allFinite()) return "has a control point that is not finite";
  }
  return {};
}

std::string yaw_fault(const PlannedYaw& yaw) {
  const auto finite = [](double x) { return std::isfinite(x); };
  if (yaw.points_rad.empty()) return finite(yaw.yaw_rad) ? "" : "its yaw is not finite";
  if (yaw.points_rad.size() < 3) return "its yaw curve has fewer than three points";
  if (!(yaw.step_s > 0.0) || !finite(yaw.step_s)) return "its yaw curve's step is not above zero";
  return std::ranges::all_of(yaw.points_rad, finite) ? "" : "its yaw curve is not finite";
}

Status check(std::span<const PlannedPiece> pieces, double step_s, const PlannedYaw& yaw,
             double start_s) {
  const auto wrong = [](const std::string& what) { return fail(ErrorCode::invalid_input, what); };
  if (pieces.empty()) return wrong("the trajectory has no piece: plan again");
  if (!(step_s > 0.0) || !std::isfinite(start_s)) {
    return wrong("sampling a trajectory needs a step above zero and a finite start");
  }
  if (const auto fault = yaw_fault(yaw); !fault.empty()) {
    return wrong("the trajectory cannot be judged: " + fault);
  }
  double samples = 0.0;
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    const std::string fault = piece_fault(pieces[i]);
    if (!fault.empty()) return wrong(fmt::format("piece {} {}: plan again", i, fault));
    samples += pieces[i].duration_s / step_s + 1.0;
  }
  if (samples < kMostSamples) return success();
  return wrong("the trajectory would take more than 10^7 samples: use a longer step");
}

}  // namespace

/// De Boor's algorithm.
double PlannedYaw::at(double t_s) const {
  if (points_rad.empty()) return yaw_rad;
  const double last = double(points_rad.size() - 2);
  const double u = std::clamp(t_s / step_s, 0.0, last);
  const auto k = std::min(std::size_t(u), points_rad.size() - 3);
  const double part = u - double(k);
  const double a = std::lerp(points_rad[k], points_rad[k + 1], (1.0 + part) / 2.0);
  const double b = std::lerp(points_rad[k + 1], points_rad[k + 2], part / 2.0);
  return std::lerp(a, b, part);
}

/// Free fall leaves the attitude open; then the vehicle is taken to be level.
Eigen::Quaterniond flat_attitude(const Vec3& acceleration_map, double yaw_rad) {
  const Vec3 thrust = acceleration_map + Vec3(0.0, 0.0, kGravity);
  const Vec3 up = thrust.norm() > 1e-6 ? Vec3(thrust.normalized()) : Vec3::UnitZ();
  const Vec3 heading(std::cos(yaw_rad), std::sin(yaw_rad), 0.0);
  Vec3 left = up.cross(heading);
  // Flying on its side along the heading: any left will do that is square to up.
  left = left.norm() > 1e-6 ? Vec3(left.normalized())
                            : Vec3(-std::sin(yaw_rad), std::cos(yaw_rad), 0.0);
  Eigen::Matrix3d R_map_base;
  R_map_base << left.cross(up), left, up;
  return Eigen::Quaterniond(R_map_base).normalized();
}

Result<std::vector<Sample>> planned_track(std::span<const PlannedPiece> pieces, double step_s,
                                          const PlannedYaw& yaw, double start_s) {
  if (auto status = check(pieces, step_s, yaw, start_s); !status) return status.error();
  std::vector<Sample> track;
  for (const PlannedPiece& piece : pieces) {
    const int steps = std::max(1, int(std::ceil(piece.duration_s / step_s)));
    for (int k = track.empty() ? 0 : 1; k <= steps; ++k) {
      const double u = double(k) / steps;
      const Moved moved = evaluate(piece, u);
      const double t_s = start_s + u * piece.duration_s;
      track.push_back(
          {t_s, moved.position_map, flat_attitude(moved.acceleration_map, yaw.at(t_s))});
    }
    start_s += piece.duration_s;
  }
  return track;
}

}  // namespace goshawk::flight_check
