#include "goshawk/tracker/disturbance_observer.hpp"

#include <cmath>

namespace goshawk::tracker {
namespace {

constexpr double kLongestGap_s = 0.1;
// Noise of a velocity, over a short time, is several times what wind can do.
constexpr double kOutlier = 5.0;

}  // namespace

DisturbanceObserver::DisturbanceObserver(double bandwidth_rad_s, double max_m_s2)
    : bandwidth_rad_s_(bandwidth_rad_s), max_m_s2_(max_m_s2) {}

void DisturbanceObserver::reset() {
  running_ = false;
  disturbance_map_.setZero();
}

void DisturbanceObserver::update(const Vec3& velocity_map, const Vec3& modelled_acceleration_map,
                                 double dt_s) {
  if (bandwidth_rad_s_ <= 0.0 || dt_s <= 0.0) return;
  if (running_ && dt_s <= kLongestGap_s) {
    // The exact step of the filter, so that it is stable for every bandwidth and gap.
    const double gain = 1.0 - std::exp(-bandwidth_rad_s_ * dt_s);
    Vec3 unexplained = (velocity_map - last_velocity_map_) / dt_s - modelled_acceleration_map;
    const double jump = unexplained.norm();
    if (jump > kOutlier * max_m_s2_) unexplained *= kOutlier * max_m_s2_ / jump;
    disturbance_map_ += gain * (unexplained - disturbance_map_);
    const double size = disturbance_map_.norm();
    if (size > max_m_s2_) disturbance_map_ *= max_m_s2_ / size;
  }
  running_ = true;
  last_velocity_map_ = velocity_map;
}

}  // namespace goshawk::tracker
