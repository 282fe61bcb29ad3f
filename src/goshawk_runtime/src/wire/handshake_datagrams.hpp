#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "cursor.hpp"
#include "sender_table.hpp"

namespace goshawk::runtime::wire {

/// What DDS Security sends before two participants trust each other (DDS Security 1.1, 7.4.3).
struct HandshakeMessage {
  bool is_request = false;  // the first of three, which answers nothing
  std::int64_t number = 0;  // of its sender; the same if it is sent again
};

/// @param own participant that must be the receiver
/// @return the handshake message in a well-formed datagram, if it has one for that participant
std::optional<HandshakeMessage> handshake_message(Bytes datagram, const SenderTable::Prefix& own);

/// Says "I have met you just now, and know no key of yours", in a submessage that other software
/// ignores.
std::vector<std::byte> make_greeting(const SenderTable::Prefix& from,
                                     const SenderTable::Prefix& to);

/// @return whether a well-formed datagram is a greeting for that participant
bool is_greeting(Bytes datagram, const SenderTable::Prefix& own);

/// Discovery data that says that a participant has left, as if it came from that one.
std::vector<std::byte> make_farewell(const SenderTable::Prefix& of);

}  // namespace goshawk::runtime::wire
