#pragma once

#include <fastdds/rtps/common/Locator.h>

#include <cstdint>
#include <map>
#include <mutex>
#include <optional>
#include <vector>

#include "cursor.hpp"
#include "sender_table.hpp"

namespace goshawk::runtime::wire {

/// Keeps the handshakes of DDS Security in step.
///
/// A participant that hears nothing from another for a lease forgets it, keys included, though the
/// other was only stopped or starved for a while and has forgotten nothing. When they meet again, a
/// new handshake begins, and Fast DDS 2.9.1 ignores it in the other, which has finished one: they
/// are deaf to each other for ever. So each participant greets every other one that it meets, and
/// one that has finished a handshake with the greeter forgets the greeter and meets it anew. It
/// does the same if a second request for a handshake comes that is not the first one sent again.
///
/// Forgetting is left to the thread in which leases end: Fast DDS 2.9.1 waits for ever if a thread
/// that receives forgets a participant while that thread has anything to do. So farewells never
/// reach it. The last announcement of who leaves is repeated with a lease of 10 ms instead, and
/// nothing more of that participant passes until it is forgotten.
///
/// With a forged greeting a stranger can delay a handshake, as with forged discovery data, which is
/// not encrypted either; on loopback the check of senders refuses both. If a network reorders
/// datagrams, a handshake may be made once more.
/// Safe to call from several threads.
class Handshakes {
 public:
  using Prefix = SenderTable::Prefix;
  using Locators = eprosima::fastdds::rtps::LocatorList;

  struct Greeting {
    Prefix to{};
    Locators at{};
  };

  /// Before this nothing is greeted or forgotten.
  /// @param own this participant
  void begin(const Prefix& own);

  /// Tells what Fast DDS has found out about another participant.
  void discovered(const Prefix& other, const Locators& at);
  void authorized(const Prefix& other);  // the handshake has ended
  /// @return whether it had taken leave, or was to be met anew: it did not just fall silent
  bool left(const Prefix& other);

  struct Intake {
    bool passes = true;
    std::vector<std::byte> instead{};  // a datagram that Fast DDS must read; empty: none
  };
  /// What Fast DDS must read of a well-formed datagram.
  Intake take_in(Bytes datagram);

  /// @param way through which the greetings will be sent: each goes once through each
  /// @param now_ns on a steady clock
  std::vector<Greeting> greetings(const void* way, std::int64_t now_ns);

  std::optional<Prefix> own() const;

 private:
  struct Other {
    Locators at{};
    bool is_authorized = false;
    bool is_heard = false;    // a handshake message has come since it was discovered
    bool is_leaving = false;  // Fast DDS is about to forget it
    std::vector<std::byte> announcement{};
    std::optional<std::int64_t> request{};
    std::int64_t greeted_ns = 0;
    std::vector<const void*> ways{};
  };

  bool must_forget(Other& other, Bytes datagram) const;

  mutable std::mutex mutex_;
  std::optional<Prefix> own_;
  std::map<Prefix, Other> others_;
  std::int64_t next_ns_ = 0;  // when greetings are due
};

}  // namespace goshawk::runtime::wire
