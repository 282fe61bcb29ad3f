#include "goshawk/recording_tools/replay.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "goshawk/introspection/session.hpp"
#include "goshawk/recording_tools/layout.hpp"
#include "player.hpp"
#include "qos_profiles.hpp"

namespace goshawk::recording {
namespace {

using introspection::Interruptible;

const char* type_of(const Reader& reader, const Channel& channel) {
  const auto* schema = reader.schema_of(channel);
  return schema == nullptr ? "" : schema->name.c_str();
}

/// The options with full names. @return invalid_parameter for what is not a name
Result<ReplayOptions> with_full_names(ReplayOptions o) {
  const auto complete = [](std::vector<std::string>& names) -> Status {
    for (auto& name : names) {
      auto full = introspection::full_topic_pattern(name);
      if (!full) return full.error();
      name = *full;
    }
    return success();
  };
  std::vector<std::string> single;
  for (const auto* name : {&o.plant, &o.prefix}) single.push_back(name->empty() ? "/" : *name);
  for (auto* names : {&o.topics, &o.lock_step, &single}) {
    if (auto status = complete(*names); !status) return status.error();
  }
  if (!o.plant.empty()) o.plant = single[0];
  if (!o.prefix.empty()) o.prefix = single[1];
  std::ranges::sort(o.lock_step);
  o.lock_step.erase(std::unique(o.lock_step.begin(), o.lock_step.end()), o.lock_step.end());
  return o;
}

bool in_lock_step(const ReplayOptions& o) {
  return !o.lock_step.empty() || !o.plant.empty();
}

/// Whether a channel is played; in lock step also the turns of the named nodes, but of no others.
bool wanted(const ReplayOptions& o, const std::string& topic, const std::string& type) {
  if (!o.plant.empty() && topic == kClock) return true;
  if (in_lock_step(o) && type == kTurnType) {
    return std::ranges::find(o.lock_step, turn_of(topic, type)) != o.lock_step.end();
  }
  return o.topics.empty() || introspection::matches(o.topics, topic);
}

/// @return invalid_parameter that names a node whose turns are not in the recording
Status check_turns(const Reader& reader, const ReplayOptions& o) {
  std::set<std::string> recorded;
  for (const auto& [id, channel] : reader.channels()) {
    const std::string node = turn_of(channel.topic, type_of(reader, channel));
    if (!node.empty()) recorded.insert(node);
  }
  if (!o.plant.empty() && recorded.empty()) {
    return fail(ErrorCode::invalid_parameter,
                fmt::format("--plant {}: {} was not recorded in lock step", o.plant, o.file));
  }
  for (const auto& node : o.lock_step) {
    if (recorded.contains(node)) continue;
    return fail(ErrorCode::invalid_parameter,
                fmt::format("--lock-step {}: {}{}", node, o.file,
                            recorded.empty()
                                ? " was not recorded in lock step: record a flight that was "
                                  "launched with flight_lock_step"
                                : fmt::format(" has turns of {} only", fmt::join(recorded, ", "))));
  }
  return success();
}

Status check_offset(const Reader& reader, const ReplayOptions& o) {
  if (o.start_offset_s <= duration_s(reader)) return success();
  return fail(ErrorCode::invalid_parameter,
              fmt::format("--start-offset is beyond the end: the recording is {:.3f} s long",
                          duration_s(reader)));
}

}  // namespace

double duration_s(const Reader& reader) {
  return double(reader.end_ns() - reader.start_ns()) * 1e-9;
}

std::vector<RecordedTopic> topics_of(const Reader& reader) {
  std::vector<RecordedTopic> topics;
  for (const auto& [id, channel] : reader.channels()) {
    const auto profiles = channel.metadata.find(kQosKey);
    const auto qos = offered_by_player(profiles == channel.metadata.end() ? "" : profiles->second);
    topics.push_back({channel.topic, type_of(reader, channel), reader.message_count(id),
                      qos.reliable, qos.transient_local});
  }
  return topics;
}

Result<std::set<std::uint16_t>> choose_channels(const Reader& reader, const ReplayOptions& options,
                                                const Say& say) {
  const auto o = with_full_names(options);
  if (!o) return o.error();
  if (auto status = check_turns(reader, *o); !status) return status.error();
  std::set<std::uint16_t> chosen;
  std::set<std::string> here;
  for (const auto& [id, channel] : reader.channels()) {
    here.insert(channel.topic);
    if (!wanted(*o, channel.topic, type_of(reader, channel))) continue;
    if (channel.message_encoding != "cdr" || type_of(reader, channel)[0] == '\0' ||
        !runtime::check_topic_name(channel.topic)) {
      say(channel.topic + " is skipped: it is not a ROS 2 topic with CDR messages");
      continue;
    }
    chosen.insert(id);
  }
  if (auto same = check_layout(reader, chosen); !same) {
    return fail(same.code(), fmt::format("{}: {}", o->file, same.error().message));
  }
  if (!chosen.empty()) return chosen;
  return fail(ErrorCode::invalid_input,
              fmt::format("no topic of {} is chosen: it has {}", o->file,
                          here.empty() ? "no topics" : fmt::format("{}", fmt::join(here, ", "))));
}

Result<ReplayEnd> replay(Reader& reader, const std::set<std::uint16_t>& channels,
                         const ReplayOptions& options, const Say& say) {
  auto o = with_full_names(options);
  if (!o) return o.error();
  if (auto status = check_offset(reader, *o); !status) return status.error();
  const Interruptible interruptible;
  auto context_options = runtime::ContextOptions::from_environment();
  if (!context_options) return context_options.error();
  auto context = runtime::Context::create(*context_options);
  if (!context) return context.error();
  runtime::Node node(**context, "goshawk_replay");
  Player player(node, reader, channels, *o, say);
  player.wait_for_readers();
  const auto begin_ns = node.now_ns();
  do {
    if (auto status = player.play(); !status) return status.error();
  } while (o->loop && !Interruptible::interrupted());
  player.finish();
  const double seconds = double(node.now_ns() - begin_ns) * 1e-9;
  while (o->hold && !Interruptible::interrupted()) node.spin_some(0.1);
  return ReplayEnd{player.published(), player.topics(), seconds};
}

}  // namespace goshawk::recording
