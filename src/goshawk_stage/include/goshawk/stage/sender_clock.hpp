#pragma once

#include <cstdint>
#include <deque>

#include "goshawk/core/result.hpp"

namespace goshawk::stage {

/// By how much the wall clock of another host differs from this one's, by the stamps of a message
/// that it sends regularly. A message arrives after it was sent, so the quickest of the last ones
/// bounds the difference from one side. Ages that a network explains count as agreement: clocks
/// that are set by a time server are better than this estimate.
///
/// What it finds is late by the quickest message's time on the way; that time stays the same, so
/// all that the sender dates is late by the same.
class SenderClock {
 public:
  /// A message that is not sent again if it is lost. @param stamp_ns [ns] sender's wall clock
  /// @param now_ns [ns] own monotonic clock at its arrival
  void hear(std::int64_t stamp_ns, std::int64_t now_ns);

  /// @param wall_ns, now_ns [ns] own wall clock and own monotonic clock, at the same moment
  /// @param sent_ns [ns] stamp of the message that came now and is to be dated
  /// @return [ns] sender's wall clock minus own one; 0 if they agree, or before the first message
  std::int64_t skew_ns(std::int64_t wall_ns, std::int64_t now_ns, std::int64_t sent_ns) const;

  /// @return clock_set if the skew is larger than what is compensated; names the sender
  static Status check(std::int64_t skew_ns, const char* sender);

 private:
  struct Heard {
    std::int64_t stamp_ns;
    std::int64_t now_ns;
  };
  void forget_other_clock();

  std::deque<Heard> heard_;  // the newest last
};

}  // namespace goshawk::stage
