#include "recorder.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "goshawk/introspection/schema.hpp"
#include "goshawk/introspection/session.hpp"
#include "qos_profiles.hpp"

namespace goshawk::recording {
namespace {

// Messages that may wait while the disk is busy. Maps and clouds are few and large.
constexpr int kSmallDepth = 1000;
constexpr int kLargeDepth = 20;

int depth_of(const std::string& type) {
  for (const char* large : {"VoxelGrid", "Octomap", "PointCloud2", "Image", "OccupancyGrid"}) {
    if (type.ends_with(std::string("/") + large)) return kLargeDepth;
  }
  return kSmallDepth;
}

}  // namespace

Recorder::Recorder(runtime::Context& context, runtime::Node& node, Writer writer,
                   RecorderOptions options)
    : context_(context), node_(node), writer_(std::move(writer)), options_(std::move(options)) {}

bool Recorder::wanted(const std::string& topic) const {
  if (!topic.starts_with('/')) return false;  // not a ROS topic: a service, or discovery's own
  if (introspection::matches(options_.exclude, topic)) return false;
  return options_.topics.empty() || introspection::matches(options_.topics, topic);
}

void Recorder::join() {
  std::map<std::string, Endpoints> fresh;
  for (const auto& endpoint : context_.endpoints()) {
    if (!endpoint.writer || !wanted(endpoint.topic)) continue;
    const auto track = tracks_.find(endpoint.topic);
    if (track != tracks_.end()) {
      check_late(track->second, endpoint);
    } else {
      fresh[endpoint.topic].push_back(endpoint);
    }
  }
  for (const auto& [topic, writers] : fresh) join(topic, writers);
}

// A reader is served only by writers that offer what it asks for, of its type.
void Recorder::check_late(const Track& track, const runtime::EndpointInfo& writer) {
  if (writer.type != track.type) {
    say_once(
        fmt::format("{} is recorded as {}; another writer sends {} on it, which is not recorded",
                    writer.topic, track.type, writer.type));
  } else if (track.reliable > writer.reliable || track.transient_local > writer.transient_local) {
    say_once(
        fmt::format("a later writer of {} offers less than the earlier ones: it is not recorded",
                    writer.topic));
  }
}

std::uint16_t Recorder::schema(const std::string& type) {
  const auto found = schemas_.find(type);
  if (found != schemas_.end()) return found->second;
  const auto definition = introspection::ros_msg_definition(type);
  if (!definition) {
    say_once(fmt::format(
        "the definition of {} is not known: its messages are recorded, but other tools cannot "
        "decode them",
        type));
  }
  return schemas_[type] =
             writer_.add_schema(type, definition ? "ros2msg" : "", definition ? *definition : "");
}

void Recorder::join(const std::string& topic, const Endpoints& writers) {
  Track track{writers.front().type, true, true};
  Endpoints same;
  for (const auto& writer : writers) {
    if (writer.type != track.type) continue;
    same.push_back(writer);
    track.reliable = track.reliable && writer.reliable;
    track.transient_local = track.transient_local && writer.transient_local;
  }
  tracks_[topic] = track;
  for (const auto& writer : writers) check_late(track, writer);
  Channel channel{.schema_id = schema(track.type), .topic = topic, .message_encoding = "cdr"};
  channel.metadata[kQosKey] = to_profiles(same);
  const std::uint16_t id = writer_.add_channel(std::move(channel));
  sequences_.resize(std::size_t(id) + 1);
  received_[topic] = 0;
  const runtime::Qos qos{track.reliable, track.transient_local, depth_of(track.type)};
  node_.subscribe_raw(topic, runtime::raw_message_type(runtime::wire_type_name(track.type)), qos,
                      [this, id, topic](const void* data, const runtime::MessageInfo& info) {
                        take(id, topic, *static_cast<const Bytes*>(data), info);
                      });
}

void Recorder::take(std::uint16_t channel, const std::string& topic, View bytes,
                    const runtime::MessageInfo& info) {
  ++received_[topic];
  const auto arrived = std::uint64_t(info.received_ns);
  const auto sent = info.sent_ns > 0 ? std::uint64_t(info.sent_ns) : arrived;
  const auto status = writer_.write({channel, sequences_[channel]++, arrived, sent, bytes});
  if (state_ && !status) state_ = status;
}

Status Recorder::flush() {
  const auto status = writer_.flush();
  if (state_ && !status) state_ = status;
  return state_;
}

Status Recorder::close() {
  const auto status = writer_.close();
  if (state_ && !status) state_ = status;
  return state_;
}

void Recorder::say_once(const std::string& sentence) {
  if (said_.insert(sentence).second) options_.say(sentence);
}

}  // namespace goshawk::recording
