#include "receive_filter.hpp"

#include <fastdds/rtps/transport/ChainingTransport.h>
#include <fastdds/rtps/transport/ChainingTransportDescriptor.h>
#include <fastdds/rtps/transport/TCPv4TransportDescriptor.h>
#include <fastdds/rtps/transport/TCPv6TransportDescriptor.h>
#include <fastdds/rtps/transport/TransportReceiverInterface.h>
#include <fastdds/rtps/transport/UDPv4TransportDescriptor.h>
#include <fastdds/rtps/transport/UDPv6TransportDescriptor.h>
#include <fastdds/rtps/transport/shared_mem/SharedMemTransportDescriptor.h>
#include <fastrtps/utils/IPLocator.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <map>
#include <memory>
#include <mutex>
#include <vector>

#include "../runtime_log.hpp"
#include "datagram_check.hpp"
#include "handshake_datagrams.hpp"

namespace goshawk::runtime::wire {
namespace {

namespace transport = eprosima::fastdds::rtps;
namespace rtps = eprosima::fastrtps::rtps;

constexpr const char* kLoopback = "127.0.0.1";
constexpr std::size_t kPrefixAt = 8;  // [byte] of the sender's GUID prefix in a datagram
// Fast DDS 2.9.1 may read as far past the end of a datagram: a fragment's size, which it takes from
// an earlier datagram of the same message.
constexpr std::size_t kPadding = 1U << 16;

std::span<const std::byte> bytes(const rtps::octet* buffer, std::uint32_t size) {
  return {reinterpret_cast<const std::byte*>(buffer), size};
}

class FilteringTransport : public transport::ChainingTransport {
 public:
  FilteringTransport(const transport::ChainingTransportDescriptor& low, bool loopback_only,
                     FilterOptions options)
      : ChainingTransport(low), loopback_only_(loopback_only), options_(std::move(options)) {}

  // Its threads end before what they call.
  ~FilteringTransport() override { low_level_transport_.reset(); }

  transport::TransportDescriptorInterface* get_configuration() override {
    return low_level_transport_->get_configuration();
  }
  void shutdown() override { low_level_transport_->shutdown(); }

  // The base class remembers a port that could not be opened, because another process has it, and
  // calls it open when it is asked for again: a reader with a port of its own then hears nothing.
  bool OpenInputChannel(const rtps::Locator_t& local, transport::TransportReceiverInterface* next,
                        std::uint32_t max_size) override {
    auto receiver = std::make_unique<Receiver>(*this, *next);
    if (!low_level_transport_->OpenInputChannel(local, receiver.get(), max_size)) return false;
    const std::lock_guard lock(mutex_);
    receivers_[local] = std::move(receiver);
    return true;
  }

  bool send(rtps::SenderResource* low, const rtps::octet* buffer, std::uint32_t size,
            rtps::LocatorsIterator* begin, rtps::LocatorsIterator* end,
            const std::chrono::steady_clock::time_point& timeout) override {
    if (options_.tap) options_.tap(bytes(buffer, size), true);
    if (options_.handshakes) greet(*low, timeout);
    return low->send(buffer, size, begin, end, timeout);
  }

  void receive(transport::TransportReceiverInterface* next, const rtps::octet* buffer,
               std::uint32_t size, const rtps::Locator_t& local,
               const rtps::Locator_t& remote) override {
    const auto datagram = bytes(buffer, size);
    if (options_.tap) options_.tap(datagram, false);
    std::string_view fault = fault_of(datagram);
    if (fault.empty() && loopback_only_) fault = fault_of_sender(datagram, remote);
    if (!fault.empty()) return options_.refusals->add(fault, rtps::IPLocator::to_string(remote));
    if (!options_.handshakes) return pass_on(*next, datagram, local, remote);
    const auto intake = options_.handshakes->take_in(datagram);
    if (!intake.instead.empty()) pass_on(*next, intake.instead, local, remote);
    if (intake.passes) pass_on(*next, datagram, local, remote);
  }

 private:
  /// What the transport below calls for one port.
  class Receiver : public transport::TransportReceiverInterface {
   public:
    Receiver(FilteringTransport& filter, transport::TransportReceiverInterface& next)
        : filter_(filter), next_(next) {}
    void OnDataReceived(const rtps::octet* data, std::uint32_t size, const rtps::Locator_t& local,
                        const rtps::Locator_t& remote) override {
      filter_.receive(&next_, data, size, local, remote);
    }

   private:
    FilteringTransport& filter_;
    transport::TransportReceiverInterface& next_;
  };

  static void pass_on(transport::TransportReceiverInterface& next,
                      std::span<const std::byte> datagram, const rtps::Locator_t& local,
                      const rtps::Locator_t& remote) {
    thread_local std::vector<rtps::octet> padded;
    if (padded.size() < datagram.size() + kPadding) {
      padded.assign(2 * datagram.size() + kPadding, 0);
    }
    std::memcpy(padded.data(), datagram.data(), datagram.size());
    next.OnDataReceived(padded.data(), std::uint32_t(datagram.size()), local, remote);
  }

  static SenderTable::Prefix sender_of(std::span<const std::byte> datagram) {
    SenderTable::Prefix sender;
    std::copy_n(datagram.begin() + kPrefixAt, sender.size(), sender.begin());
    return sender;
  }

  // Through the socket that discovery uses, so that a greeting comes before the handshake.
  void greet(rtps::SenderResource& low, const std::chrono::steady_clock::time_point& timeout) {
    const std::int64_t now_ns =
        std::chrono::nanoseconds(std::chrono::steady_clock::now().time_since_epoch()).count();
    for (const auto& [to, at] : options_.handshakes->greetings(&low, now_ns)) {
      const auto greeting = make_greeting(*options_.handshakes->own(), to);
      transport::Locators begin(at.begin()), end(at.end());
      low.send(reinterpret_cast<const rtps::octet*>(greeting.data()),
               std::uint32_t(greeting.size()), &begin, &end, timeout);
    }
  }

  std::string_view fault_of_sender(std::span<const std::byte> datagram,
                                   const rtps::Locator_t& remote) {
    constexpr std::array<rtps::octet, 4> kLoopbackAddress{127, 0, 0, 1};
    if (!std::equal(kLoopbackAddress.begin(), kLoopbackAddress.end(), remote.address + 12)) {
      return "it does not come from 127.0.0.1";
    }
    const bool own =
        options_.senders->admits(sender_of(datagram), rtps::IPLocator::getPhysicalPort(remote));
    return own ? "" : "it names a participant that sends from another port";
  }

  bool loopback_only_;
  FilterOptions options_;
  std::mutex mutex_;
  std::map<rtps::Locator_t, std::unique_ptr<Receiver>> receivers_;
};

bool listens_on_loopback_only(const transport::UDPv4TransportDescriptor& udp) {
  return !udp.interfaceWhiteList.empty() &&
         std::ranges::all_of(udp.interfaceWhiteList, [](const auto& i) { return i == kLoopback; });
}
bool listens_on_loopback_only(const transport::TransportDescriptorInterface&) {
  return false;
}

/// What ChainingTransport is made from; nobody asks it for a transport.
struct LowTransport : transport::ChainingTransportDescriptor {
  using ChainingTransportDescriptor::ChainingTransportDescriptor;
  transport::TransportInterface* create_transport() const override { return nullptr; }
};

/// Of the same class as what it filters: Fast DDS asks descriptors of TCP and shared memory for it.
template <typename Plain>
class Filtered : public Plain {
 public:
  Filtered(const Plain& plain, FilterOptions options)
      : Plain(plain), options_(std::move(options)) {}

  transport::TransportInterface* create_transport() const override {
    const Plain& plain = *this;
    return new FilteringTransport(LowTransport(std::make_shared<Plain>(plain)),
                                  listens_on_loopback_only(plain), options_);
  }

 private:
  FilterOptions options_;
};

template <typename Plain>
bool filter_as(const std::shared_ptr<transport::TransportDescriptorInterface>& plain,
               const FilterOptions& options,
               std::shared_ptr<transport::TransportDescriptorInterface>& out) {
  const auto* of_kind = dynamic_cast<const Plain*>(plain.get());
  if (of_kind != nullptr) out = std::make_shared<Filtered<Plain>>(*of_kind, options);
  return of_kind != nullptr;
}

}  // namespace

void Refusals::add(std::string_view fault, const std::string& from) {
  const std::lock_guard lock(mutex_);
  last_ = fmt::format("{}, from {}", fault, from);
  if (!std::has_single_bit(++count_)) return;
  runtime_log().warn("a datagram was refused ({} so far): {}", count_, last_);
}

std::uint64_t Refusals::count() const {
  const std::lock_guard lock(mutex_);
  return count_;
}

std::string Refusals::last() const {
  const std::lock_guard lock(mutex_);
  return last_;
}

std::shared_ptr<transport::TransportDescriptorInterface> filtered(
    const std::shared_ptr<transport::TransportDescriptorInterface>& plain,
    const FilterOptions& options) {
  auto out = plain;
  (void)(filter_as<transport::UDPv4TransportDescriptor>(plain, options, out) ||
         filter_as<transport::UDPv6TransportDescriptor>(plain, options, out) ||
         filter_as<transport::TCPv4TransportDescriptor>(plain, options, out) ||
         filter_as<transport::TCPv6TransportDescriptor>(plain, options, out) ||
         filter_as<transport::SharedMemTransportDescriptor>(plain, options, out));
  return out;
}

}  // namespace goshawk::runtime::wire
