#pragma once

#include <cstdint>

#include "goshawk/runtime/node.hpp"
#include "goshawk/stage/stage_reporter.hpp"
#include "goshawk_msgs.h"

namespace goshawk::stage {

/// `navigator_alive`: the newest state again, stamped when it is sent. From these stamps the
/// tracker learns by how much the clocks of two hosts differ, and without them it lands.
class LifeSign {
 public:
  /// Sends twice a second. The reporter and the state must outlive it, and it must not be moved.
  LifeSign(runtime::Node& node, StageReporter& reporter,
           const goshawk_msgs::msg::NavigatorState& state);
  LifeSign(const LifeSign&) = delete;
  LifeSign& operator=(const LifeSign&) = delete;

  /// Before anything is sent that this process' wall clock dates: if the clock was set,
  /// receivers must know first.
  void before_commit();

 private:
  void send();

  runtime::Node& node_;
  StageReporter& reporter_;
  const goshawk_msgs::msg::NavigatorState& state_;
  runtime::Publisher<goshawk_msgs::msg::NavigatorState> alive_;
  std::int64_t sent_offset_ns_ = 0;  // wall clock less monotonic clock, when it was last sent
};

}  // namespace goshawk::stage
