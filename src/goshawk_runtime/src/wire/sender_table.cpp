#include "sender_table.hpp"

namespace goshawk::runtime::wire {

bool SenderTable::admits(const Prefix& participant, std::uint16_t port) {
  const std::lock_guard lock(mutex_);
  const auto known = port_of_.find(participant);
  if (known != port_of_.end()) return known->second == port;
  const auto [at, is_new] = participant_at_.try_emplace(port, participant);
  if (!is_new) {  // the port of a process that has ended was given to another
    port_of_.erase(at->second);
    at->second = participant;
  }
  port_of_.emplace(participant, port);
  return true;
}

std::size_t SenderTable::size() const {
  const std::lock_guard lock(mutex_);
  return port_of_.size();
}

}  // namespace goshawk::runtime::wire
