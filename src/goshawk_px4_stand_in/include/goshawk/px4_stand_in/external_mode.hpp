#pragma once

#include <cstdint>
#include <optional>

#include "goshawk/px4_stand_in/wire.hpp"
#include "goshawk/px4_wire/release.hpp"

namespace goshawk::px4_stand_in {

/// One slot for a mode of another program: registration, arming checks, and when it is
/// unresponsive. Times are counted as PX4 does: a request each 300 ms, a reply missed 50 ms after
/// it, unresponsive at the fourth miss in a row (1.15: the third), the eleventh before the first
/// reply.
class ExternalMode {
 public:
  explicit ExternalMode(px4::Release release) : release_(release) {}

  void hear(const px4::RegisterExtComponentRequest& m, bool armed, Wire& wire);
  void hear(const px4::UnregisterExtComponent& m, bool armed);
  void hear(const px4::ArmingCheckReply& m);
  void step(std::int64_t now_ns, Wire& wire);

  bool registered() const { return registered_; }
  bool responsive() const { return registered_ && !unresponsive_; }
  /// The newest reply says that it can run.
  bool can_run() const { return responsive() && can_run_; }
  std::uint8_t mode() const { return px4::nav_state::kExternal1; }
  /// An unresponsive mode that is not selected is removed while disarmed.
  void remove() { registered_ = false; }

 private:
  int most_misses() const;

  px4::Release release_;
  bool registered_ = false, unresponsive_ = false, can_run_ = false, replied_ = false;
  bool awaited_ = false;  // a reply to the newest request
  std::uint8_t request_id_ = 0;
  int misses_ = 0;
  std::optional<std::int64_t> asked_ns_;
};

}  // namespace goshawk::px4_stand_in
