#pragma once

#include <cstdint>
#include <random>
#include <vector>

namespace goshawk::lab {

/// What a link does to the packets of one direction.
struct LinkFaults {
  double delay_s = 0.0;      // [s] of every packet
  double jitter_s = 0.0;     // [s] at the most, added to the delay; packets keep their order
  double loss = 0.0;         // probability that a packet is lost
  double duplicate = 0.0;    // probability that it comes twice
  double reorder = 0.0;      // probability that it is held back, so that later ones overtake it
  double held_back_s = 0.01;  // [s] for how long
};

/// When the packets of one direction of a link leave it. Time and randomness are arguments.
class Impairment {
 public:
  explicit Impairment(std::uint64_t seed) : random_(seed) {}

  void set(const LinkFaults& faults) { faults_ = faults; }
  const LinkFaults& faults() const { return faults_; }
  /// Nothing passes before that moment.
  void cut_until(double time_s) { cut_until_s_ = time_s; }

  /// @param now_s [s] when the packet came; not before the one of the last call
  /// @return [s] when each copy of it leaves; empty: it is lost
  std::vector<double> departures(double now_s);

 private:
  bool happens(double probability);

  std::mt19937_64 random_;
  LinkFaults faults_;
  double cut_until_s_ = 0.0;
  double last_s_ = 0.0;  // departure of the newest packet that kept its order
};

}  // namespace goshawk::lab
