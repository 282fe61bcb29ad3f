#pragma once

#include <cstdint>
#include <vector>

#include "goshawk/core/moving_box.hpp"

namespace goshawk::flight_report {

/// All that moved, at one moment.
struct MoversMoment {
  double t_s = 0.0;  // [s] on the flight's clock
  std::vector<MovingBox> boxes = {};
};

/// Where a box was thought to go. Times count from the moment of the prediction.
struct PredictedBox {
  /// Of the track of its centre: a Bezier curve.
  struct Piece {
    double duration_s = 0.0;
    std::vector<Vec3> control_points_map = {};
  };
  std::uint64_t id = 0;
  Quaternion q_map_box = Quaternion::Identity();
  Vec3 half_extents_m = Vec3::Zero();
  std::vector<Piece> track = {};
  double error_m = 0.0;  // the centre is within error + error_rate t of the track
  double error_rate_m_s = 0.0;
  double valid_until_s = 0.0;
};

/// All predictions of one moment.
struct PredictionsMoment {
  double t_s = 0.0;  // [s] on the flight's clock
  std::vector<PredictedBox> boxes = {};
};

/// @return invalid_input for a box that fails its own check; for predictions with numbers that are
/// not finite or beyond 1e6, a quaternion without length 1, negative sizes or errors, a track
/// without pieces, a piece without points or duration
Status check_movers(const std::vector<MoversMoment>& movers,
                    const std::vector<PredictionsMoment>& predictions);

}  // namespace goshawk::flight_report
