#pragma once

#include "goshawk/core/random.hpp"
#include "goshawk/core/vector.hpp"

namespace goshawk::simulator {

/// A constant wind with gusts on top: on each axis a first-order Gauss-Markov process, as the
/// Dryden model reduces to at low height and speed. Frame `map`. The same seed gives the same wind.
class Wind {
 public:
  struct Parameters {
    Vec3 mean_map = Vec3::Zero();     // [m/s]
    double gust_deviation_m_s = 0.0;  // standard deviation on each axis, >= 0
    double gust_time_s = 1.0;         // correlation time, > 0
    std::uint64_t seed = 1;
  };

  /// @param step_s the fixed time between calls of step(), > 0
  Wind(const Parameters& parameters, double step_s);

  void step();
  /// Takes effect with the next step; gusts approach the new deviation with their correlation time.
  void change(const Vec3& mean_map, double gust_deviation_m_s) {
    mean_map_ = mean_map;
    deviation_m_s_ = gust_deviation_m_s;
  }
  Vec3 velocity_map() const { return mean_map_ + gust_map_; }

 private:
  Vec3 mean_map_;
  Vec3 gust_map_ = Vec3::Zero();
  double deviation_m_s_;
  double decay_;    // of a gust over one step
  double renewal_;  // keeps the deviation stationary
  Random random_;
};

}  // namespace goshawk::simulator
