#pragma once

#include <cstdint>
#include <vector>

#include "goshawk/core/random.hpp"
#include "goshawk/core/vehicle.hpp"

namespace goshawk::simulator {

/// Errors of the vehicle's state estimate: a delay, and white noise on every part. All zero: the
/// estimate is the truth. The same seed gives the same noise.
struct SensorParameters {
  double position_noise_m = 0.0;    // standard deviation on each axis, >= 0; so are all
  double velocity_noise_m_s = 0.0;  // map
  double attitude_noise_rad = 0.0;  // about each body axis
  double body_rate_noise_rad_s = 0.0;
  double delay_s = 0.0;  // of the newest estimate; its stamp is its true time
  int seed = 1;

  bool is_perfect() const {
    return position_noise_m == 0.0 && velocity_noise_m_s == 0.0 && attitude_noise_rad == 0.0 &&
           body_rate_noise_rad_s == 0.0 && delay_s == 0.0;
  }
};

struct Measurement {
  RigidBodyState state;
  std::int64_t time_ns = 0;  // [ns] when the state was true
};

class Sensor {
 public:
  /// @param step_ns the fixed time between calls of record(), > 0
  Sensor(const SensorParameters& parameters, std::int64_t step_ns);

  /// Starts over with this state, as if it had always been.
  void reset(const RigidBodyState& state, std::int64_t time_ns);
  void record(const RigidBodyState& state, std::int64_t time_ns);

  /// The oldest recorded state, with fresh noise.
  Measurement measure();

 private:
  SensorParameters parameters_;
  Random random_;
  std::vector<Measurement> ring_;  // one more than the delay has steps
  std::size_t oldest_ = 0;
};

}  // namespace goshawk::simulator
