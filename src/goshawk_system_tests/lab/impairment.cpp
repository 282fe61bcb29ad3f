#include "impairment.hpp"

#include <algorithm>

namespace goshawk::lab {

bool Impairment::happens(double probability) {
  return std::uniform_real_distribution<>(0.0, 1.0)(random_) < probability;
}

std::vector<double> Impairment::departures(double now_s) {
  if (now_s < cut_until_s_ || happens(faults_.loss)) return {};
  const double jitter_s = faults_.jitter_s * std::uniform_real_distribution<>(0.0, 1.0)(random_);
  double leaves_s = std::max(last_s_, now_s + faults_.delay_s + jitter_s);
  if (happens(faults_.reorder)) {
    leaves_s += faults_.held_back_s;
  } else {
    last_s_ = leaves_s;
  }
  return std::vector<double>(happens(faults_.duplicate) ? 2 : 1, leaves_s);
}

}  // namespace goshawk::lab
