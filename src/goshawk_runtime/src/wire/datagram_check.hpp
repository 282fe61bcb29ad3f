#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

namespace goshawk::runtime::wire {

constexpr std::int64_t kMostSequence = std::int64_t(1) << 48;  // 8 years at 1 MHz
constexpr std::int64_t kMostGap = 65'536;  // samples that one GAP may skip: Fast DDS visits each
constexpr std::uint32_t kMostSample = 256U << 20;  // [byte] of a message sent in fragments

/// Checks an RTPS 2 datagram before Fast DDS reads it. Fast DDS 2.9.1 trusts what it reads: it ends
/// the process by an assertion, reads and writes past buffers, allocates what a length claims, or
/// loops over 2^63 numbers. What is admitted here is well-formed: all submessages lie in the
/// datagram, each holds what its kind requires, and discovery data is what its lengths say.
///
/// Pure; it allocates nothing and takes time proportional to the length.
/// @param datagram as received
/// @return what is wrong, for a log; empty if the datagram is admitted
std::string_view fault_of(std::span<const std::byte> datagram) noexcept;

inline bool admits(std::span<const std::byte> datagram) noexcept {
  return fault_of(datagram).empty();
}

}  // namespace goshawk::runtime::wire
