#pragma once

#include <map>
#include <string>
#include <vector>

#include "goshawk/recording/reader.hpp"
#include "goshawk/runtime/node.hpp"
#include "goshawk/introspection/schema.hpp"

namespace goshawk::recording {

struct PlayerOptions {
  double rate = 1.0;
  double start_offset_s = 0.0;  // from the first message of the recording
  double wait_s = 3.0;          // longest wait for readers to be found
  bool clock = false;           // publish /clock
  bool restamp = false;         // move stamps to now
  std::string prefix;           // before every topic
};

/// Publishes recorded messages as they were, at the times they came.
class Player {
 public:
  /// @param channels that are played. @throws StartupFault where a topic cannot be written
  Player(runtime::Node& node, Reader& reader, const std::set<std::uint16_t>& channels,
         PlayerOptions options);

  /// Waits until those who read are found.
  void wait_for_readers();
  /// Plays all once. Ctrl-C ends it. @return io_failed
  Status play();
  /// Waits until what was sent has arrived.
  void finish();

  std::uint64_t published() const { return published_; }
  std::size_t topics() const { return tracks_.size(); }

 private:
  struct Track {
    runtime::RawPublisher publisher;
    const introspection::Type* type = nullptr;  // nullptr: not known here
    bool transient_local = false;
  };
  Status publish_latched_before(std::uint64_t from_ns);
  Status publish(Track& track, View data, std::uint64_t log_time_ns);
  void wait_until(std::int64_t steady_ns);
  void publish_clock();

  runtime::Node& node_;
  Reader& reader_;
  PlayerOptions options_;
  std::map<std::uint16_t, Track> tracks_;  // by channel
  std::set<std::uint16_t> channels_;
  runtime::RawPublisher clock_;
  Bytes message_;
  std::uint64_t published_ = 0;
  std::uint64_t from_ns_ = 0;     // log time that is played at ...
  std::int64_t begin_ns_ = 0;     // ... this steady time
  bool playing_ = false;
};

}  // namespace goshawk::recording
