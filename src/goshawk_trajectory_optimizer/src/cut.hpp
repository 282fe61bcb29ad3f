#pragma once

#include <algorithm>
#include <cmath>

#include "goshawk/trajectory_optimizer/plan.hpp"

namespace goshawk::trajectory_optimizer {

inline bool is_moving(const FlatState& s) {
  return !s.velocity.isZero(0.0) || !s.acceleration.isZero(0.0);
}

/// How a flight is cut into pieces: as long as they may be, shorter towards its ends.
struct Cutter {
  double total_s = 0.0;    // the flight's
  double longest_s = 0.0;  // of the pieces
  double first = 1.0;      // the first piece, in longest ones; each next is at most twice as long
  double last = 1.0;

  // The sooner the first piece from rest ends, the sooner the acceleration is there.
  static constexpr double kFromRest = 0.4;
  // Of a flight of hours, whose pieces are longer then.
  static constexpr double kMostPieces = 2000.0;

  /// @param at_moving_end first or last if that end moves
  static Cutter of(const PlanRequest& request, const Config& config, double total_s,
                   double at_moving_end) {
    const double longest_s = std::max(config.piece_duration_s, total_s / kMostPieces);
    return {total_s, std::min(longest_s, total_s / config.min_pieces),
            is_moving(request.start) ? at_moving_end : kFromRest,
            is_moving(request.goal) ? at_moving_end : kFromRest};
  }

  /// Cuts what begins at begin_s and lasts duration_s, calling piece(end since begin_s, duration).
  template <typename Piece>
  void cut(double begin_s, double duration_s, Piece&& piece) const {
    for (double t = 0.0, left = 1.0; left > 0.0;) {
      left = std::ceil((duration_s - t) / cap_s(begin_s + t) - 1e-9) - 1.0;
      const double piece_s = left > 0.0 ? (duration_s - t) / (left + 1.0) : duration_s - t;
      t += piece_s;
      piece(t, piece_s);
    }
  }

 private:
  // Of a piece that begins or ends at t.
  double cap_s(double t) const {
    const double at_start = std::max(first * longest_s, t);
    const double at_goal = std::max(last * longest_s, 0.5 * (total_s - t));
    return std::min({longest_s, at_start, at_goal});
  }
};

inline void append(Plan& plan, double duration_s, int polytope, const FlatState& end) {
  plan.durations_s.push_back(duration_s);
  plan.polytopes.push_back(polytope);
  plan.knots.push_back(end);
}

}  // namespace goshawk::trajectory_optimizer
