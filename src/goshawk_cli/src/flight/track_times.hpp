#pragma once

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <optional>

namespace goshawk::cli {

/// The times of a flown track: the stamps of odometry, which go on evenly although somebody sets
/// the clock that makes them. A gap in odometry stays a gap.
class TrackTimes {
 public:
  /// @param heard_ns when the odometry of this stamp came, on the monotonic clock
  /// @return [ns] its time; later than that of the one before, unless its stamp is the same
  std::int64_t time_ns(std::int64_t stamp_ns, std::int64_t heard_ns) {
    if (last_) {
      const std::int64_t by_stamps_ns = stamp_ns - last_->stamp_ns;
      const std::int64_t by_hearing_ns = heard_ns - last_->heard_ns;
      // Stamps that follow closely are right, however late they are heard of.
      const bool skips = by_stamps_ns > kStep_ns && by_stamps_ns - by_hearing_ns > kStep_ns;
      if (skips || by_stamps_ns < 0) {  // one source sends in order
        set_by_ns_ += by_stamps_ns - std::max<std::int64_t>(by_hearing_ns, 1);
      }
    }
    last_ = {stamp_ns, heard_ns};
    return stamp_ns - set_by_ns_;
  }

 private:
  struct Last {
    std::int64_t stamp_ns, heard_ns;
  };
  static constexpr std::int64_t kStep_ns = 100'000'000;  // a smaller step on is not told from delay
  std::optional<Last> last_;
  std::int64_t set_by_ns_ = 0;
};

}  // namespace goshawk::cli
