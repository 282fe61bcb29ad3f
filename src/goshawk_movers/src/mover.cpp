#include "goshawk/movers/mover.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace goshawk::movers {

BoxState Mover::at(double t_s) const {
  return std::visit([&](const auto& m) { return m.at(t_s - start_s); }, motion);
}

OrientedBox Mover::box_at(double t_s) const {
  const BoxState state = at(t_s);
  return {state.position_map, state.q_map_box, half_m};
}

double Mover::top_speed_m_s() const {
  return std::visit([](const auto& m) { return m.top_speed_m_s(); }, motion);
}

double Mover::top_point_speed_m_s() const {
  const double turn = std::visit([](const auto& m) { return m.top_turn_rad_s(); }, motion);
  return top_speed_m_s() + turn * reach_m();
}

std::optional<BallContact> first_contact(const MovingBall& ball, const Mover& mover,
                                         double tolerance_m) {
  const double span_s = ball.to_s - ball.from_s;
  const bool usable = is_finite(ball.from_map) && is_finite(ball.to_map) && std::isfinite(span_s) &&
                      span_s >= 0.0 && ball.radius_m >= 0.0 && std::isfinite(ball.radius_m) &&
                      tolerance_m > 0.0;
  if (!usable) {
    throw std::invalid_argument(
        "first_contact: a ball needs finite ends, times in order and a radius of 0 or more; the "
        "tolerance must be above 0");
  }
  const Vec3 way = ball.to_map - ball.from_map;
  // Distances shrink by no more than this from the interval's begin to its end.
  const double approach_m = way.norm() + mover.top_point_speed_m_s() * span_s;
  double part = 0.0;
  while (true) {
    const double t_s = ball.from_s + part * span_s;
    const Vec3 center = ball.from_map + part * way;
    const Vec3 nearest = mover.box_at(t_s).nearest_map(center);
    const double gap_m = (nearest - center).norm() - ball.radius_m;
    if (gap_m <= tolerance_m) return BallContact{t_s, nearest};
    if (part >= 1.0 || approach_m <= 0.0) return std::nullopt;
    // What is left of the gap at the end of the step is half the tolerance: steps do not vanish.
    const double next = std::min(1.0, part + (gap_m - 0.5 * tolerance_m) / approach_m);
    // Nearer than times can be told apart: the next moment may be a contact.
    if (next <= part) return BallContact{t_s, nearest};
    part = next;
  }
}

}  // namespace goshawk::movers
