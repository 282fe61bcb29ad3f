#pragma once

#include <cstdint>
#include <optional>

#include "goshawk/core/result.hpp"
#include "goshawk/px4/config.hpp"
#include "goshawk/px4/link.hpp"

namespace goshawk::px4 {

/// Goshawk as a mode of PX4's: asks for it, answers PX4's arming checks honestly, and says which
/// setpoints the mode sends.
class Registration {
 public:
  /// @param seed of the request's id: another one for each process
  Registration(const Config& config, std::uint64_t seed);

  /// Asks for the mode until PX4 gives it. PX4 that does not ask for 4 s has forgotten it.
  void step(std::int64_t now_ns, Link& link);
  /// @return not_permitted if PX4 refuses
  Status hear(const RegisterExtComponentReply& reply, std::int64_t now_ns);
  /// Answers at once.
  /// @param can_run whether Goshawk would fly if the mode were selected now
  void hear(const ArmingCheckRequest& request, bool can_run, std::int64_t now_ns, Link& link);
  void hear(const SetpointConfigReply& reply);

  /// While the mode becomes active, and until PX4 has confirmed it (1.18).
  void configure(std::int64_t now_ns, Link& link);
  void activated() {
    configured_ = false;
    unconfirmed_ = 0;
  }

  /// The nav_state of the mode; nothing while it is not registered.
  std::optional<std::uint8_t> mode() const { return mode_; }
  bool unanswered() const { return !mode_ && tries_ >= 5; }

 private:
  void forget();

  Release release_;
  std::uint16_t setpoint_type_;
  std::uint64_t request_id_;
  int tries_ = 0;
  std::optional<std::int64_t> asked_ns_;
  std::optional<std::int64_t> configured_ns_;
  bool configured_ = false;
  int unconfirmed_ = 0;  // times that it was said
  std::optional<std::uint8_t> mode_;
  std::uint8_t check_id_ = 0;
  std::int64_t heard_ns_ = 0;  // the last arming check
};

}  // namespace goshawk::px4
