#pragma once

#include <cstdint>
#include <optional>

namespace goshawk::tracker {

/// Brings stamps of odometry to the tracker's monotonic clock. Another clock made them, and either
/// clock may be set at any moment. What holds all the same: a measurement arrives after it was
/// made, measurements come in order, and between two of them both clocks see the same time pass. A
/// difference that breaks one of these is a clock that was set; then a measurement is as old as the
/// one before it was.
class OdometryClock {
 public:
  struct Reading {
    std::int64_t time_ns = 0;  // [ns] monotonic: when the measurement was made; never after arrival
    double set_by_s = 0.0;     // [s] by how much a clock was set since the last one; 0: not at all
  };

  /// @param longest_age_s what arrives older than this is late, whatever the clocks say; > 0
  explicit OdometryClock(double longest_age_s);

  /// @param stamp_ns [ns] as sent, @param wall_ns, now_ns [ns] own wall clock and own monotonic
  ///        clock, both at arrival
  /// @pre within 1e18 ns of zero
  Reading read(std::int64_t stamp_ns, std::int64_t wall_ns, std::int64_t now_ns);

 private:
  struct Last {
    std::int64_t stamp_ns;
    std::int64_t now_ns;
  };

  std::int64_t longest_age_ns_;
  std::int64_t offset_ns_ = 0;  // monotonic time less stamp
  std::int64_t usual_age_ns_ = 0;
  std::optional<Last> last_;
};

}  // namespace goshawk::tracker
