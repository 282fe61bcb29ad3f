#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <map>
#include <mutex>
#include <optional>

namespace goshawk::runtime::wire {

/// Who sends from which port of 127.0.0.1.
///
/// A Fast DDS participant sends from one port all its life, and no other process can send from that
/// port while it lives. So a datagram that names a participant, but comes from another port, is
/// forged: it would end that participant's topics, silence a reader, or pass as its data.
/// Safe to call from several threads.
class SenderTable {
 public:
  using Prefix = std::array<std::byte, 12>;  // of a participant's GUID

  /// @return false if the participant was heard from another port before
  bool admits(const Prefix& participant, std::uint16_t port);

  /// @return the port that it was heard from, or nothing if it was not heard
  std::optional<std::uint16_t> port_of(const Prefix& participant) const;

  /// @return whether the port that it was heard from was since given to another: of the last 64
  bool has_ended(const Prefix& participant) const;

  std::size_t size() const;  // at most one a port

 private:
  mutable std::mutex mutex_;
  std::map<Prefix, std::uint16_t> port_of_;
  std::map<std::uint16_t, Prefix> participant_at_;
  std::deque<Prefix> ended_;
};

/// @return whether a socket of any process has this UDP port of 127.0.0.1; sockets that share
///         ports (SO_REUSEADDR) do not count
bool is_taken(std::uint16_t port);

}  // namespace goshawk::runtime::wire
