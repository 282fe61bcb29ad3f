#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

/// Fast DDS alone: no node, no generated type between the measurement and the middleware.
namespace goshawk::bench {

enum class Quality {
  reliable_last,  // as our topics have it
  reliable_all,   // nothing may get lost: a full reader holds the writer back
  best_effort,
};

struct LinkOptions {
  std::string way = "udp";   // "udp", "shared_memory", "loans", "one_process"
  std::uint32_t bytes = 16;  // of a sample, at least 16
  int domain = 0;
  bool reliable = true;  // whether of a flood nothing may get lost
  bool asynchronous = false;
  bool listener = false;  // the middleware's thread calls; else a thread that waits on a wait set
};

/// Ways that exist, in the order of the report.
std::vector<std::string> ways();

/// What the first bytes of a sample say.
struct Stamp {
  std::uint64_t number = 0;
  std::int64_t sent_ns = 0;  // [ns] steady clock of the machine
};

std::int64_t steady_ns();

/// A participant of the domain with the transports of a way.
class Member {
 public:
  /// @throws std::runtime_error if the domain cannot be joined
  explicit Member(const LinkOptions& options);
  ~Member();
  struct Impl;
  Impl& impl() { return *impl_; }

 private:
  std::unique_ptr<Impl> impl_;
};

/// One direction's beginning.
class Sender {
 public:
  Sender(Member& member, const std::string& topic, Quality quality = Quality::reliable_last);
  ~Sender();
  /// @return false if the middleware did not take it (the reader held it back too long)
  bool send(Stamp stamp);
  int matched() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// One direction's end.
class Receiver {
 public:
  using Callback = std::function<void(const Stamp&)>;
  /// @param callback in the middleware's thread with LinkOptions::listener, else inside of wait()
  Receiver(Member& member, const std::string& topic, Callback callback,
           Quality quality = Quality::reliable_last);
  ~Receiver();
  /// Takes what is there or comes within timeout_s. Without effect for a listener.
  void wait(double timeout_s);
  int matched() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace goshawk::bench
