#pragma once

#include <functional>
#include <string>
#include <vector>

namespace goshawk::bench {

/// One of several ways to do the same work.
struct Contender {
  std::string name;
  std::function<void()> run;  // once, whole; what it computes must not be thrown away
};

/// What one contender took, sorted. Timings of one compare() were taken side by side.
struct Timing {
  std::vector<double> sorted_us;  // [us], one a round

  double median_us() const { return quantile_us(0.5); }
  double p90_us() const { return quantile_us(0.9); }
  /// @param q in [0, 1]; nearest rank @pre at least one sample (throws else)
  double quantile_us(double q) const;
  void append(const Timing& other);
};

/// What is read before and after a turn.
enum class Clock {
  wall,
  processor,  // of the thread that calls: leaves out what other programs take; costs 0.2 us a turn
};

/// Runs every contender once a round, in an order that turns, so that a noisy machine disturbs all
/// alike; after one round that is not counted. Google Benchmark drives it.
/// @param rounds >= 1 (throws else)
/// @return one timing a contender, in their order
std::vector<Timing> compare(const std::string& name, const std::vector<Contender>& contenders,
                            int rounds, Clock clock = Clock::wall);

/// @return [us] what one run takes, for work that cannot be repeated
double time_us(const std::function<void()>& run, Clock clock);

/// @return the nearest rank at a share in [0, 1] of sorted numbers; 0 if there are none
double at_share(const std::vector<double>& sorted, double share);

/// Of any numbers, nearest rank. @pre not empty (throws else)
double median(std::vector<double> values);

}  // namespace goshawk::bench
