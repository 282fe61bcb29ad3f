#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "goshawk/introspection/schema.hpp"
#include "goshawk/recording_tools/replay.hpp"
#include "goshawk/runtime/node.hpp"
#include "turns.hpp"

namespace goshawk::recording {

/// Publishes recorded messages with their recorded timing; in lock step in the order of their
/// publication, without pauses, while each node runs only in its turn.
class Player {
 public:
  /// @param options whose names are full. @throws StartupFault if a topic cannot be written
  Player(runtime::Node& node, Reader& reader, const std::set<std::uint16_t>& channels,
         ReplayOptions options, Say say);

  /// Waits until readers are found.
  void wait_for_readers();
  /// Plays all once. Ctrl-C ends it. @return io_failed
  Status play();
  /// Waits until all messages have arrived.
  void finish();

  std::uint64_t published() const { return published_; }
  std::size_t topics() const { return tracks_.size(); }

 private:
  struct Track {
    runtime::RawPublisher publisher;
    const introspection::Type* type = nullptr;  // nullptr: not known here
    bool transient_local = false;
    bool reliable = false;
    std::string turn_of = {};  // full name of the node whose turns these are
  };
  struct Held {
    std::uint16_t channel = 0;
    std::uint64_t log_time_ns = 0;
    Bytes data;
  };
  int matched() const;
  void wait_for_turn_takers();
  void wait_for_turn_taker(const runtime::RawPublisher& turns, const std::string& node);
  void settle(double longest_s);
  void call_the_roll(const std::string& node);
  Status play_in_time();
  Status play_in_lock_step();
  Status play_held(std::uint64_t until_ns);
  Status play_in_order(Held& held);
  Status publish_latched_before(std::uint64_t from_ns);
  Status publish(Track& track, View data, std::uint64_t log_time_ns);
  void wait_until(std::int64_t steady_ns);
  void publish_clock();

  runtime::Node& node_;
  Reader& reader_;
  ReplayOptions options_;
  Say say_;
  std::map<std::uint16_t, Track> tracks_;  // by channel
  std::set<std::uint16_t> channels_;
  runtime::RawPublisher clock_;
  std::optional<TurnGiver> turns_;           // in lock step
  std::multimap<std::uint64_t, Held> held_;  // by the time of publication
  std::set<std::string> roll_;               // nodes that had a turn
  runtime::RawPublisher plant_turns_;
  Bytes message_;
  std::uint64_t published_ = 0;
  std::uint64_t from_ns_ = 0;  // log time that is played at ...
  std::int64_t begin_ns_ = 0;  // ... this steady time
  bool playing_ = false;
};

}  // namespace goshawk::recording
