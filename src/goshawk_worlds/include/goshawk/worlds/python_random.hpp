#pragma once

#include <array>
#include <cstdint>

namespace goshawk::worlds {

/// The numbers of CPython's `random.Random(seed)`: the Mersenne Twister MT19937 (Matsumoto and
/// Nishimura, 1998), seeded by the array {seed}, with 53 bits a number. Published worlds are
/// generated with it.
class PythonRandom {
 public:
  explicit PythonRandom(std::uint32_t seed);

  /// As random.random(): uniform in [0, 1)
  double uniform();
  /// As random.uniform(lo, hi)
  double uniform(double lo, double hi) { return lo + (hi - lo) * uniform(); }

 private:
  static constexpr std::size_t kWords = 624;
  std::uint32_t next();
  void turn();

  std::array<std::uint32_t, kWords> state_{};
  std::size_t at_ = kWords;
};

}  // namespace goshawk::worlds
