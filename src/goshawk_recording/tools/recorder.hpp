#pragma once

#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "goshawk/recording/writer.hpp"
#include "goshawk/recording_tools/record.hpp"
#include "goshawk/runtime/node.hpp"

namespace goshawk::recording {

struct RecorderOptions {
  std::vector<std::string> topics;   // full names, or beginnings with '*'; none: all
  std::vector<std::string> exclude;  // the same
  Say say;
};

/// Joins topics as their writers appear, and writes every message that comes.
class Recorder {
 public:
  Recorder(runtime::Context& context, runtime::Node& node, Writer writer, RecorderOptions options);

  /// Looks for new topics. Call it some twenty times a second.
  void join();

  /// The first failure to write: nothing is recorded after it.
  const Status& state() const { return state_; }
  Status flush();
  /// @return the first failure, or success once the file is whole
  Status close();

  WriterCounts counts() const { return writer_.counts(); }
  /// Messages that came, by topic.
  const std::map<std::string, std::uint64_t>& received() const { return received_; }

 private:
  struct Track {
    std::string type;
    bool reliable = false;
    bool transient_local = false;
  };
  using Endpoints = std::vector<runtime::EndpointInfo>;

  bool wanted(const std::string& topic) const;
  void join(const std::string& topic, const Endpoints& writers);
  void check_late(const Track& track, const runtime::EndpointInfo& writer);
  std::uint16_t schema(const std::string& type);
  void take(std::uint16_t channel, const std::string& topic, View bytes,
            const runtime::MessageInfo& info);
  void say_once(const std::string& sentence);

  runtime::Context& context_;
  runtime::Node& node_;
  Writer writer_;
  RecorderOptions options_;
  Status state_ = success();
  std::map<std::string, Track> tracks_;            // by topic
  std::map<std::string, std::uint16_t> schemas_;   // by type
  std::map<std::string, std::uint64_t> received_;  // by topic
  std::vector<std::uint32_t> sequences_;           // by channel
  std::set<std::string> said_;
};

}  // namespace goshawk::recording
