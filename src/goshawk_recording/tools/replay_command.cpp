#include <cmath>
#include <cstdio>

#include "goshawk/recording/commands.hpp"
#include "goshawk/recording_tools/layout.hpp"
#include "player.hpp"
#include "print_messages.hpp"
#include "qos_profiles.hpp"
#include "verb.hpp"

namespace goshawk::recording {
namespace {

struct Options {
  std::string file;
  std::vector<std::string> topics;
  std::vector<std::string> lock_step;
  PlayerOptions player;
  bool loop = false;
  bool hold = false;
  bool list = false;
  bool print = false;
  bool json = false;
};

void add_options(CLI::App& app, Options& o) {
  app.add_option("file", o.file, "an MCAP recording")->required();
  app.add_option("-t,--topics", o.topics, "names, or beginnings like /uav1/* (default: all)");
  app.add_option("-r,--rate", o.player.rate, "times as fast as it was")
      ->capture_default_str()
      ->check(CLI::Range(1e-3, 1e3));
  app.add_option("--start-offset", o.player.start_offset_s, "[s] leave out the beginning")
      ->capture_default_str()
      ->check(CLI::Range(0.0, 1e9));
  app.add_flag("-l,--loop", o.loop, "again and again, until Ctrl-C");
  app.add_flag("--clock", o.player.clock, "publish the recording's time on /clock, at 100 Hz");
  app.add_flag("--restamp", o.player.restamp,
               "move the stamps inside of messages to now: stages refuse requests whose deadline "
               "has passed");
  app.add_option("--lock-step", o.lock_step,
                 "nodes that run with lock_step: true: they are given the recorded turns, so that "
                 "each takes the same messages at the same time as in the recording")
      ->expected(1, -1);
  app.add_option(
      "--plant", o.player.plant,
      "the node that led the recording, where it is to be given turns as well, by /clock");
  app.add_option("--prefix", o.player.prefix, "before every topic, as in /replay");
  app.add_option("--wait", o.player.wait_s, "[s] longest wait for readers before the start")
      ->capture_default_str()
      ->check(CLI::Range(0.0, 1e4));
  app.add_flag("--hold", o.hold, "stay after the end, so that latched topics can be read");
  app.add_flag("--list", o.list, "only say what is in the file");
  app.add_flag("--print", o.print, "only print the messages, a line of JSON each");
  app.add_flag("--json", o.json, "print one JSON object (docs/cli.md)");
}

double duration_s(const Reader& reader) {
  return double(reader.end_ns() - reader.start_ns()) * 1e-9;
}

const char* type_of(const Reader& reader, const Channel& channel) {
  const auto* schema = reader.schema_of(channel);
  return schema == nullptr ? "" : schema->name.c_str();
}

Json contents(const Reader& reader, const Options& o) {
  Json topics = Json::array();
  for (const auto& [id, channel] : reader.channels()) {
    const auto profiles = channel.metadata.find(kQosKey);
    const auto qos = offered_by_player(profiles == channel.metadata.end() ? "" : profiles->second);
    topics.push_back({{"name", channel.topic},
                      {"type", type_of(reader, channel)},
                      {"messages", reader.message_count(id)},
                      {"reliability", qos.reliable ? "reliable" : "best_effort"},
                      {"durability", qos.transient_local ? "transient_local" : "volatile"}});
  }
  return {{"ok", true},
          {"code", "ok"},
          {"message", ""},
          {"file", o.file},
          {"whole", reader.complaints().empty()},
          {"complaints", reader.complaints()},
          {"messages", reader.message_count()},
          {"start_s", double(reader.start_ns()) * 1e-9},
          {"duration_s", duration_s(reader)},
          {"topics", topics}};
}

int list(const Reader& reader, const Options& o) {
  const Json all = contents(reader, o);
  if (o.json) {
    print_json(all);
    return kDone;
  }
  std::printf("%s: %llu messages, %.3f s\n", o.file.c_str(),
              (unsigned long long)reader.message_count(), duration_s(reader));
  for (const auto& topic : all["topics"]) {
    std::printf("  %-28s %-36s %9llu  %s%s\n", topic["name"].get<std::string>().c_str(),
                topic["type"].get<std::string>().c_str(),
                (unsigned long long)topic["messages"].get<std::uint64_t>(),
                topic["reliability"].get<std::string>().c_str(),
                topic["durability"] == "transient_local" ? ", latched" : "");
  }
  return kDone;
}

/// Whether a channel is played: in lock step with the turns of the nodes that were named, and not
/// with those of others.
bool wanted(const Options& o, const std::string& topic, const std::string& type) {
  if (!o.player.plant.empty() && topic == kClock) return true;
  if ((!o.player.lock_step.empty() || !o.player.plant.empty()) && type == kTurnType) {
    return o.player.lock_step.contains(turn_of(topic, type));
  }
  return o.topics.empty() || matches(o.topics, topic);
}

/// @return invalid_parameter that names a node whose turns are not in the recording
Status check_turns(const Reader& reader, const Options& o) {
  std::set<std::string> recorded;
  std::string list;
  for (const auto& [id, channel] : reader.channels()) {
    const std::string node = turn_of(channel.topic, type_of(reader, channel));
    if (!node.empty() && recorded.insert(node).second) list += (list.empty() ? "" : ", ") + node;
  }
  if (!o.player.plant.empty() && recorded.empty()) {
    return fail(ErrorCode::invalid_parameter,
                "--plant " + o.player.plant + ": " + o.file + " was not recorded in lock step");
  }
  for (const auto& node : o.player.lock_step) {
    if (recorded.contains(node)) continue;
    return fail(ErrorCode::invalid_parameter,
                "--lock-step " + node + ": " + o.file +
                    (list.empty() ? " was not recorded in lock step: record a flight that was "
                                    "launched with flight_lock_step"
                                  : " has turns of " + list + " only"));
  }
  return success();
}

/// Channels of the chosen topics that DDS can carry.
Result<std::set<std::uint16_t>> choose(const Reader& reader, const Options& o) {
  std::set<std::uint16_t> chosen;
  std::string here;
  for (const auto& [id, channel] : reader.channels()) {
    here += (here.empty() ? "" : ", ") + channel.topic;
    if (!wanted(o, channel.topic, type_of(reader, channel))) continue;
    if (channel.message_encoding != "cdr" || type_of(reader, channel)[0] == '\0' ||
        !runtime::check_topic_name(channel.topic)) {
      say("replay",
          channel.topic + " is left out: it is no topic of ROS 2, whose messages are CDR");
      continue;
    }
    chosen.insert(id);
  }
  if (chosen.empty()) {
    return fail(ErrorCode::invalid_input, "nothing of " + o.file + " is to be played: it has " +
                                              (here.empty() ? "no topics" : here));
  }
  return chosen;
}

int print_end(const Player& player, const Options& o, double seconds) {
  if (o.json) {
    print_json({{"ok", true},
                {"code", "ok"},
                {"message", ""},
                {"file", o.file},
                {"published", player.published()},
                {"topics", player.topics()},
                {"duration_s", seconds}});
  } else {
    std::printf("%llu messages of %zu topics played in %.1f s\n",
                (unsigned long long)player.published(), player.topics(), seconds);
  }
  return kDone;
}

int play(Reader& reader, const std::set<std::uint16_t>& channels, const Options& o) {
  const Interruptible interruptible;
  auto context = join_domain();
  if (!context) return report_failure("replay", context.error(), o.json, kNotDone);
  runtime::Node node(**context, "goshawk_replay");
  Player player(node, reader, channels, o.player);
  player.wait_for_readers();
  const auto begin_ns = node.now_ns();
  do {
    if (auto status = player.play(); !status) {
      return report_failure("replay", status.error(), o.json, kNotDone);
    }
  } while (o.loop && !Interruptible::interrupted());
  player.finish();
  const double seconds = double(node.now_ns() - begin_ns) * 1e-9;
  while (o.hold && !Interruptible::interrupted()) node.spin_some(0.1);
  return print_end(player, o, seconds);
}

int replay(const Options& o) {
  auto reader = Reader::open(o.file);
  if (!reader) return report_failure("replay", reader.error(), o.json, kNotDone);
  for (const auto& complaint : reader->complaints()) say("replay", o.file + ": " + complaint);
  if (o.list) return list(*reader, o);
  if (auto status = check_turns(*reader, o); !status) {
    return report_failure("replay", status.error(), o.json, kWrongCall);
  }
  const auto channels = choose(*reader, o);
  if (!channels) return report_failure("replay", channels.error(), o.json, kNotDone);
  if (auto same = check_layout(*reader, *channels); !same) {
    const Error error = fail(same.code(), o.file + ": " + same.error().message);
    return report_failure("replay", error, o.json, kNotDone);
  }
  if (o.print) {
    const auto printed = print_messages(*reader, *channels);
    return printed ? kDone : report_failure("replay", printed.error(), o.json, kNotDone);
  }
  if (o.player.start_offset_s > duration_s(*reader)) {
    char text[32];
    std::snprintf(text, sizeof text, "%.3f", duration_s(*reader));
    return report_failure(
        "replay",
        fail(ErrorCode::invalid_parameter,
             std::string("--start-offset lies behind the end: the recording is ") + text +
                 " s long"),
        o.json, kWrongCall);
  }
  try {
    return play(*reader, *channels, o);
  } catch (const runtime::StartupFault& fault) {
    return report_failure("replay", fault.error(), o.json, kNotDone);
  }
}

}  // namespace

int replay_command(const std::vector<std::string>& arguments) {
  CLI::App app("Play a recording over DDS: same topics, types, bytes and quality of service.",
               "goshawk replay");
  app.footer(
      "Examples:\n"
      "  goshawk replay flight.mcap --list\n"
      "  goshawk replay flight.mcap --rate 0.5 --loop --clock\n"
      "  goshawk replay flight.mcap --topics /plan_request /map/* --restamp");
  Options o;
  add_options(app, o);
  if (const auto status = parse(app, arguments)) return *status;
  for (auto& topic : o.topics) {
    auto full = full_topic_name(topic);
    if (!full) return report_failure("replay", full.error(), o.json, kWrongCall);
    topic = *full;
  }
  for (const auto& node : o.lock_step) {
    auto full = full_topic_name(node);
    if (!full) return report_failure("replay", full.error(), o.json, kWrongCall);
    o.player.lock_step.insert(*full);
  }
  if (!o.player.plant.empty()) {
    auto full = full_topic_name(o.player.plant);
    if (!full) return report_failure("replay", full.error(), o.json, kWrongCall);
    o.player.plant = *full;
  }
  if (!o.player.prefix.empty()) {
    auto full = full_topic_name(o.player.prefix);
    if (!full) return report_failure("replay", full.error(), o.json, kWrongCall);
    o.player.prefix = *full;
  }
  return replay(o);
}

}  // namespace goshawk::recording
