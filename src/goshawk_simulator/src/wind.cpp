#include "goshawk/simulator/wind.hpp"

#include <cmath>

namespace goshawk::simulator {

Wind::Wind(const Parameters& parameters, double step_s)
    : mean_map_(parameters.mean_map),
      deviation_m_s_(parameters.gust_deviation_m_s),
      decay_(std::exp(-step_s / parameters.gust_time_s)),
      renewal_(std::sqrt(1.0 - decay_ * decay_)),
      random_(parameters.seed) {
  if (deviation_m_s_ > 0.0) {
    // One by one: the order in which arguments are evaluated is the compiler's choice.
    for (int i = 0; i < 3; ++i) gust_map_[i] = deviation_m_s_ * normal();
  }
}

void Wind::step() {
  if (!(deviation_m_s_ > 0.0)) return;
  for (int i = 0; i < 3; ++i) {
    gust_map_[i] = decay_ * gust_map_[i] + renewal_ * deviation_m_s_ * normal();
  }
}

// Sum of twelve uniform numbers: close to normal, bounded by six deviations, and made of additions
// only, so that every machine draws the same.
double Wind::normal() {
  double sum = -6.0;
  for (int i = 0; i < 12; ++i) sum += random_.uniform();
  return sum;
}

}  // namespace goshawk::simulator
