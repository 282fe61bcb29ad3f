#pragma once

#include "cursor.hpp"

namespace goshawk::runtime::wire {

/// Checks the parameter list of inline QoS, and moves the cursor behind it.
/// @return false if a parameter leaves the submessage, or does not have the form of its kind
bool well_formed_inline_qos(Cursor& at);

/// Checks a sample of a built-in topic: discovery (a parameter list), liveliness, or the handshake
/// of DDS Security.
/// @param writer, reader RTPS EntityIds of the submessage
/// @return false if Fast DDS must not read it; true for a sample of another topic
bool well_formed_builtin_sample(std::uint32_t reader, std::uint32_t writer, Bytes payload);

/// @return whether one end is a built-in endpoint whose samples are checked
bool is_builtin(std::uint32_t reader, std::uint32_t writer);

}  // namespace goshawk::runtime::wire
