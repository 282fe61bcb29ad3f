#pragma once

#include <fastdds/rtps/transport/TransportDescriptorInterface.h>

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <span>
#include <string>
#include <string_view>

#include "handshakes.hpp"
#include "sender_table.hpp"

namespace goshawk::runtime::wire {

/// Counts the datagrams that the filters of a participant have refused, and logs them: the 1st,
/// 2nd, 4th, 8th and so on, so that a flood does not fill the disk. Safe to call from several
/// threads.
class Refusals {
 public:
  void add(std::string_view fault, const std::string& from);

  std::uint64_t count() const;
  std::string last() const;  // fault and sender of the last one; empty: none yet

 private:
  mutable std::mutex mutex_;
  std::uint64_t count_ = 0;
  std::string last_;
};

struct FilterOptions {
  std::shared_ptr<Refusals> refusals;
  std::shared_ptr<SenderTable> senders;      // of the transport that listens on 127.0.0.1 alone
  std::shared_ptr<Handshakes> handshakes{};  // null without DDS Security
  std::function<void(std::span<const std::byte> datagram, bool sent)> tap{};  // may be empty
};

/// A transport that passes on only what fault_of() admits. If it listens on 127.0.0.1 alone, it
/// also refuses what comes from elsewhere, and what names a participant that sends from another
/// port. Under DDS Security it greets each participant that is met (handshakes.hpp).
///
/// @param plain UDPv4, UDPv6, TCPv4, TCPv6 or shared memory
/// @return a descriptor of the same kind; the given one itself if it is of none of these
std::shared_ptr<eprosima::fastdds::rtps::TransportDescriptorInterface> filtered(
    const std::shared_ptr<eprosima::fastdds::rtps::TransportDescriptorInterface>& plain,
    const FilterOptions& options);

}  // namespace goshawk::runtime::wire
