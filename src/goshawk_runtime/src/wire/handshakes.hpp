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
/// A participant that hears nothing from another for a lease forgets it, keys included, though that
/// one was only stopped or starved for a while, and has forgotten nothing. When they meet again,
/// one begins a new handshake, and Fast DDS 2.9.1 ignores that in the other, which has finished
/// one: they are deaf to each other for ever. So each participant greets whom it meets, and one
/// that believes a handshake with the greeter to be finished forgets it and meets it anew. The same
/// holds if a second request for a handshake comes that is not the first sent again.
///
/// A greeting decides nothing that a stranger could not decide: discovery itself is not encrypted.
/// It counts as said by whom it names, so it must have passed the checks of its sender. On one host
/// datagrams keep their order; if they do not, a handshake may be made once more.
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
  void left(const Prefix& other);

  /// Reads a well-formed datagram.
  /// @return whether Fast DDS must forget its sender before it reads it
  bool must_forget(Bytes datagram);

  /// @param way through which the greetings will be sent: each goes once through each
  /// @param now_ns on a steady clock
  std::vector<Greeting> greetings(const void* way, std::int64_t now_ns);

  std::optional<Prefix> own() const;

 private:
  struct Other {
    Locators at{};
    bool is_authorized = false;
    bool is_heard = false;  // a handshake message has come since it was discovered
    std::optional<std::int64_t> request{};
    std::int64_t greeted_ns = 0;
    std::vector<const void*> ways{};
  };

  mutable std::mutex mutex_;
  std::optional<Prefix> own_;
  std::map<Prefix, Other> others_;
  std::int64_t next_ns_ = 0;  // when greetings are due
};

}  // namespace goshawk::runtime::wire
