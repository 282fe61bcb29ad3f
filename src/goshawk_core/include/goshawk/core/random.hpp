#pragma once

#include <cstdint>

namespace goshawk {

/// SplitMix64 (Steele, Lea, Flood 2014): the same numbers on every machine and compiler, which
/// the standard library's distributions do not promise. The seed is always an argument.
class Random {
 public:
  explicit Random(std::uint64_t seed) : state_(seed) {}

  std::uint64_t next() {
    std::uint64_t z = (state_ += 0x9E3779B97F4A7C15ULL);
    z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9ULL;
    z = (z ^ (z >> 27)) * 0x94D049BB133111EBULL;
    return z ^ (z >> 31);
  }

  /// @return uniform in [0, 1), a multiple of 2^-53
  double uniform() { return double(next() >> 11) * 0x1.0p-53; }
  double uniform(double lo, double hi) { return lo + (hi - lo) * uniform(); }

  /// @return uniform in {0, ..., n - 1}. @pre n >= 1
  int below(int n) { return int(((next() >> 32) * std::uint64_t(unsigned(n))) >> 32); }
  bool chance(double probability) { return uniform() < probability; }

 private:
  std::uint64_t state_;
};

}  // namespace goshawk
