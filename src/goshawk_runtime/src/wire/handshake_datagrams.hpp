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

/// @return whether a well-formed datagram holds discovery data of a participant that is there
bool is_announcement(Bytes datagram);

/// @return whether a well-formed datagram says that a participant has left
bool is_farewell(Bytes datagram);

/// The announcement alone, made later than any that its sender made, and good for 10 ms only.
/// @pre is_announcement(announcement)
std::vector<std::byte> make_brief(Bytes announcement);

}  // namespace goshawk::runtime::wire
