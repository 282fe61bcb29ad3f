#include "goshawk/simulator/wind.hpp"

#include <cmath>

#include "goshawk/simulator/normal.hpp"

namespace goshawk::simulator {

Wind::Wind(const Parameters& parameters, double step_s)
    : mean_map_(parameters.mean_map),
      deviation_m_s_(parameters.gust_deviation_m_s),
      decay_(std::exp(-step_s / parameters.gust_time_s)),
      renewal_(std::sqrt(1.0 - decay_ * decay_)),
      random_(parameters.seed) {
  if (deviation_m_s_ > 0.0) gust_map_ = normal_vector(random_, deviation_m_s_);
}

void Wind::step() {
  gust_map_ *= decay_;
  if (deviation_m_s_ > 0.0) gust_map_ += normal_vector(random_, renewal_ * deviation_m_s_);
}

}  // namespace goshawk::simulator
