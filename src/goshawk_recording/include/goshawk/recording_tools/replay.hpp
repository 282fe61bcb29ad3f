#pragma once

#include <set>
#include <string>
#include <vector>

#include "goshawk/recording/reader.hpp"
#include "goshawk/recording_tools/record.hpp"

namespace goshawk::recording {

struct ReplayOptions {
  std::string file;                    // for sentences
  std::vector<std::string> topics;     // names, or beginnings like /uav1/*; none: all
  double rate = 1.0;                   // times as fast as it was
  double start_offset_s = 0.0;         // from the first message of the recording
  double wait_s = 3.0;                 // longest wait for readers to be found
  bool clock = false;                  // publish /clock
  bool restamp = false;                // move stamps to now
  bool loop = false;                   // again and again, until Ctrl-C
  bool hold = false;                   // stay after the end, until Ctrl-C
  std::string prefix;                  // before every topic
  std::vector<std::string> lock_step;  // nodes that are given their recorded turns
  std::string plant;                   // node that led, if it is to follow
};

/// A topic of a recording.
struct RecordedTopic {
  std::string name;
  std::string type;
  std::uint64_t messages = 0;
  bool reliable = false;
  bool transient_local = false;
};
std::vector<RecordedTopic> topics_of(const Reader& reader);

/// [s] from the first message to the last.
double duration_s(const Reader& reader);

/// Channels of the chosen topics that DDS can carry.
/// @return invalid_parameter for a name that is wrong, or a node whose turns were not recorded;
/// invalid_input if nothing is left, or if another version recorded a topic with another layout
Result<std::set<std::uint16_t>> choose_channels(const Reader& reader, const ReplayOptions& options,
                                                const Say& say);

struct ReplayEnd {
  std::uint64_t published = 0;
  std::size_t topics = 0;
  double duration_s = 0.0;
};

/// Plays over DDS: same topics, types, bytes and quality of service. Ctrl-C ends it.
/// @return invalid_parameter for an offset behind the end; io_failed
Result<ReplayEnd> replay(Reader& reader, const std::set<std::uint16_t>& channels,
                         const ReplayOptions& options, const Say& say);

/// A line of JSON on stdout for each message of these channels: topic, type, log_time_s, bytes,
/// crc32 of the bytes, value (null if its type is not known here or the bytes are not such a
/// message).
/// @return io_failed
Status print_messages(Reader& reader, const std::set<std::uint16_t>& channels);

}  // namespace goshawk::recording
