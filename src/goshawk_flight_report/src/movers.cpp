#include "goshawk/flight_report/movers.hpp"

#include <fmt/format.h>

#include <cmath>

namespace goshawk::flight_report {
namespace {

constexpr double kFarthestMover_m = 1e6;

bool is_near(const Vec3& v) {
  return v.allFinite() && v.cwiseAbs().maxCoeff() <= kFarthestMover_m;
}

bool is_amount(double value) {
  return value >= 0.0 && value <= kFarthestMover_m;
}

bool is_box(const Quaternion& q, const Vec3& half_extents_m) {
  return std::abs(q.norm() - 1.0) < 1e-6 && is_near(half_extents_m) &&
         half_extents_m.minCoeff() >= 0.0;
}

bool is_track(const std::vector<PredictedBox::Piece>& track) {
  for (const auto& piece : track) {
    if (!(piece.duration_s > 0.0 && is_amount(piece.duration_s))) return false;
    if (piece.control_points_map.empty()) return false;
    for (const Vec3& p : piece.control_points_map) {
      if (!is_near(p)) return false;
    }
  }
  return !track.empty();
}

Error wrong_prediction(const char* what, std::uint64_t id) {
  return fail(ErrorCode::invalid_input,
              fmt::format("the predicted {} of moving box {} is empty, negative, not finite or "
                          "beyond 1e6",
                          what, id));
}

Error no_time(const char* of) {
  return fail(ErrorCode::invalid_input, fmt::format("the time of {} is not finite", of));
}

}  // namespace

Status check_movers(const std::vector<MoversMoment>& movers,
                    const std::vector<PredictionsMoment>& predictions) {
  for (const auto& moment : movers) {
    if (!std::isfinite(moment.t_s)) return no_time("moving boxes");
    for (const MovingBox& box : moment.boxes) {
      if (auto status = box.check(); !status) return status;
    }
  }
  for (const auto& moment : predictions) {
    if (!std::isfinite(moment.t_s)) return no_time("predictions");
    for (const PredictedBox& box : moment.boxes) {
      if (!is_box(box.q_map_box, box.half_extents_m)) return wrong_prediction("shape", box.id);
      if (!is_track(box.track)) return wrong_prediction("track", box.id);
      if (!is_amount(box.error_m) || !is_amount(box.error_rate_m_s) ||
          !is_amount(box.valid_until_s)) {
        return wrong_prediction("bound", box.id);
      }
    }
  }
  return success();
}

}  // namespace goshawk::flight_report
