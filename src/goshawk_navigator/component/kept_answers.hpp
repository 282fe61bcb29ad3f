#pragma once

#include <algorithm>
#include <cstdint>
#include <deque>

#include "goshawk_msgs.h"

namespace goshawk::navigator {

/// Trajectories as they came, until one is committed.
class KeptAnswers {
 public:
  std::uint64_t keep(const goshawk_msgs::msg::BezierTrajectory& m, std::int64_t wire_ns) {
    if (kept_.size() == kMost) kept_.pop_front();
    kept_.push_back({++number_, m, wire_ns});
    return number_;
  }
  struct Kept {
    std::uint64_t number;
    goshawk_msgs::msg::BezierTrajectory message;
    std::int64_t wire_ns;
  };
  const Kept* find(std::uint64_t number) const {
    const auto at = std::ranges::find(kept_, number, &Kept::number);
    return at == kept_.end() ? nullptr : &*at;
  }

 private:
  static constexpr std::size_t kMost = 4;
  std::deque<Kept> kept_;
  std::uint64_t number_ = 0;
};

}  // namespace goshawk::navigator
