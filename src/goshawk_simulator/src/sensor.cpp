#include "goshawk/simulator/sensor.hpp"

#include <cmath>

#include "goshawk/simulator/normal.hpp"

namespace goshawk::simulator {

Sensor::Sensor(const SensorParameters& parameters, std::int64_t step_ns)
    : parameters_(parameters),
      random_(std::uint64_t(parameters.seed)),
      ring_(std::size_t(std::llround(parameters.delay_s * 1e9 / double(step_ns))) + 1) {}

void Sensor::reset(const RigidBodyState& state, std::int64_t time_ns) {
  random_ = Random(std::uint64_t(parameters_.seed));
  for (auto& entry : ring_) entry = {state, time_ns};
  oldest_ = 0;
}

void Sensor::record(const RigidBodyState& state, std::int64_t time_ns) {
  ring_[oldest_] = {state, time_ns};
  oldest_ = (oldest_ + 1) % ring_.size();
}

Measurement Sensor::measure() {
  Measurement m = ring_[oldest_];
  const auto& p = parameters_;
  if (p.position_noise_m > 0.0) m.state.position_map += normal_vector(random_, p.position_noise_m);
  if (p.velocity_noise_m_s > 0.0) {
    m.state.velocity_map += normal_vector(random_, p.velocity_noise_m_s);
  }
  if (p.attitude_noise_rad > 0.0) {
    const Vec3 half = normal_vector(random_, 0.5 * p.attitude_noise_rad);
    m.state.q_map_base =
        (m.state.q_map_base * Eigen::Quaterniond(1.0, half.x(), half.y(), half.z())).normalized();
  }
  if (p.body_rate_noise_rad_s > 0.0) {
    m.state.angular_velocity_base += normal_vector(random_, p.body_rate_noise_rad_s);
  }
  return m;
}

}  // namespace goshawk::simulator
