#pragma once

#include <vector>

#include "dds/link.hpp"

namespace goshawk::bench {

/// Answers every ping with a pong of the same size, and counts the flood, until stopping().
/// @param member shared with the other side, or nullptr for one of its own
void echo(const LinkOptions& options, Member* member, const std::function<bool()>& stopping);

struct Trips {
  std::vector<double> us;  // [us] there and back
  int lost = 0;
};

struct Flood {
  int sent = 0;
  int received = 0;
  double elapsed_s = 0.0;  // from the first one sent to the last one received
};

/// The side that asks: meets an echo, then measures.
class Asker {
 public:
  /// @throws std::runtime_error if no echo is found within 20 s
  Asker(const LinkOptions& options, Member& member);

  /// @param pause_s between an answer and the next question
  Trips round_trips(int count, double most_s, double pause_s = 0.0);
  /// As fast as the middleware takes them, for time_s.
  Flood flood(double time_s);

 private:
  bool ask(Stamp stamp, double timeout_s);
  /// @return how many of the flood the echo has, and when the last one came
  Stamp counted();

  LinkOptions options_;
  Sender pings_, flood_;
  std::uint64_t number_ = 0;
  Stamp answer_;
  Receiver pongs_;
};

}  // namespace goshawk::bench
