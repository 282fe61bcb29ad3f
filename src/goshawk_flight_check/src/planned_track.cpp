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

Status check(std::span<const PlannedPiece> pieces, double step_s, double start_s) {
  const auto wrong = [](const std::string& what) { return fail(ErrorCode::invalid_input, what); };
  if (pieces.empty()) return wrong("the trajectory has no piece: plan again");
  if (!(step_s > 0.0)) return wrong("to sample a trajectory, use a step above zero");
  if (!std::isfinite(start_s)) return wrong("to sample a trajectory, use a finite start");
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

/// Free fall leaves the attitude open; then the vehicle is taken to be level.
Quaternion flat_attitude(const Vec3& acceleration_map, double yaw_rad) {
  const Vec3 thrust = acceleration_map + Vec3(0.0, 0.0, kGravity);
  const Vec3 up = thrust.norm() > 1e-6 ? Vec3(thrust.normalized()) : Vec3::UnitZ();
  const Vec3 heading(std::cos(yaw_rad), std::sin(yaw_rad), 0.0);
  Vec3 left = up.cross(heading);
  // Flying on its side along the heading: any left will do that is square to up.
  left = left.norm() > 1e-6 ? Vec3(left.normalized())
                            : Vec3(-std::sin(yaw_rad), std::cos(yaw_rad), 0.0);
  Eigen::Matrix3d R_map_base;
  R_map_base << left.cross(up), left, up;
  return Quaternion(Eigen::Quaterniond(R_map_base).normalized());
}

Result<std::vector<Sample>> planned_track(std::span<const PlannedPiece> pieces, double step_s,
                                          const std::function<double(double)>& yaw_rad_at,
                                          double start_s) {
  if (auto status = check(pieces, step_s, start_s); !status) return status.error();
  std::vector<Sample> track;
  for (const PlannedPiece& piece : pieces) {
    const int steps = std::max(1, int(std::ceil(piece.duration_s / step_s)));
    for (int k = track.empty() ? 0 : 1; k <= steps; ++k) {
      const double u = double(k) / steps;
      const Moved moved = evaluate(piece, u);
      const double t_s = start_s + u * piece.duration_s;
      const double yaw_rad = yaw_rad_at ? yaw_rad_at(t_s) : 0.0;
      if (!std::isfinite(yaw_rad)) {
        return fail(ErrorCode::invalid_input,
                    fmt::format("the planned yaw at {:.3g} s is not finite: plan again", t_s));
      }
      track.push_back({t_s, moved.position_map, flat_attitude(moved.acceleration_map, yaw_rad)});
    }
    start_s += piece.duration_s;
  }
  return track;
}

}  // namespace goshawk::flight_check
