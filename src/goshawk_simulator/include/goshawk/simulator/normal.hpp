#pragma once

#include "goshawk/core/random.hpp"
#include "goshawk/core/vector.hpp"

namespace goshawk::simulator {

/// Sum of twelve uniform numbers: close to normal, bounded by six deviations, and made of additions
/// only, so that every machine draws the same.
inline double normal(Random& random) {
  double sum = -6.0;
  for (int i = 0; i < 12; ++i) sum += random.uniform();
  return sum;
}

inline Vec3 normal_vector(Random& random, double deviation) {
  Vec3 v;
  // One statement each: the order in which arguments are evaluated is unspecified.
  for (int i = 0; i < 3; ++i) v[i] = deviation * normal(random);
  return v;
}

}  // namespace goshawk::simulator
