#pragma once

#include <mutex>
#include <set>

#include "goshawk/runtime/node.hpp"
#include "mutator.hpp"

namespace goshawk::hostile {

/// A member of the domain that reads every topic, and keeps the datagrams of it: those that others
/// send to it, and its own.
class Observer {
 public:
  struct Captured {
    std::vector<Bytes> sent, received;  // different ones, each with a header
  };

  /// @throws std::runtime_error with a sentence if the domain cannot be joined
  Observer();

  /// Reads the topics that are there by now, and serves for a while.
  void watch(double for_s);
  Captured captured() const;

 private:
  void keep(std::span<const std::byte> datagram, bool sent);

  mutable std::mutex mutex_;
  std::set<Bytes> sent_, received_;
  std::unique_ptr<runtime::Context> context_;
  std::unique_ptr<runtime::Node> node_;
  std::set<std::string> topics_;
};

}  // namespace goshawk::hostile
