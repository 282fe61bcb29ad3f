#include "sender_table.hpp"

#include <arpa/inet.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <utility>

namespace goshawk::runtime::wire {
namespace {

constexpr std::size_t kMostEnded = 64;  // one sender can use up any number of names

}  // namespace

bool SenderTable::admits(const Prefix& participant, std::uint16_t port) {
  const std::lock_guard lock(mutex_);
  const auto known = port_of_.find(participant);
  if (known != port_of_.end()) return known->second == port;
  const auto [at, is_new] = participant_at_.try_emplace(port, participant);
  if (!is_new) {  // the port of a process that has ended was given to another
    port_of_.erase(at->second);
    ended_.push_back(std::exchange(at->second, participant));
    if (ended_.size() > kMostEnded) ended_.pop_front();
  }
  port_of_.emplace(participant, port);
  return true;
}

std::optional<std::uint16_t> SenderTable::port_of(const Prefix& participant) const {
  const std::lock_guard lock(mutex_);
  const auto known = port_of_.find(participant);
  if (known == port_of_.end()) return {};
  return known->second;
}

bool SenderTable::has_ended(const Prefix& participant) const {
  const std::lock_guard lock(mutex_);
  return std::ranges::find(ended_, participant) != ended_.end() && !port_of_.contains(participant);
}

std::size_t SenderTable::size() const {
  const std::lock_guard lock(mutex_);
  return port_of_.size();
}

bool is_taken(std::uint16_t port) {
  const int tried = ::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  if (tried < 0) return true;  // nobody can tell
  // Sockets that both say so may share a port, so two who look at the same moment do not take each
  // other for the owner. Fast DDS does not say so of what it sends from.
  const int yes = 1;
  setsockopt(tried, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(port);
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  const bool free = bind(tried, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0;
  close(tried);
  return !free;
}

}  // namespace goshawk::runtime::wire
