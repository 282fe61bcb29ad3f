#include "goshawk/recording_tools/replay.hpp"

#include <fmt/format.h>

#include "verbs/verbs.hpp"

namespace goshawk::cli {
namespace {

struct ReplayCall {
  recording::ReplayOptions replay;
  bool list = false;
  bool print = false;
};

int list_recording(const recording::Reader& reader, const std::string& file, const Console& console) {
  Json topics = Json::array();
  const auto all = recording::topics_of(reader);
  for (const auto& t : all) {
    topics.push_back({{"name", t.name},
                      {"type", t.type},
                      {"messages", t.messages},
                      {"reliability", t.reliable ? "reliable" : "best_effort"},
                      {"durability", t.transient_local ? "transient_local" : "volatile"}});
  }
  if (console.json()) {
    Json object = ok_json();
    object.update({{"file", file},
                   {"whole", reader.complaints().empty()},
                   {"complaints", reader.complaints()},
                   {"messages", reader.message_count()},
                   {"start_s", double(reader.start_ns()) * 1e-9},
                   {"duration_s", recording::duration_s(reader)},
                   {"topics", topics}});
    console.print(object);
    return kDone;
  }
  fmt::print("{}: {} messages, {:.3f} s\n", file, reader.message_count(),
             recording::duration_s(reader));
  for (const auto& t : all) {
    fmt::print("  {:<28} {:<36} {:>9}  {}{}\n", t.name, t.type, t.messages,
               t.reliable ? "reliable" : "best_effort", t.transient_local ? ", latched" : "");
  }
  return kDone;
}

int tell(const recording::ReplayEnd& end, const std::string& file, const Console& console) {
  if (console.json()) {
    Json object = ok_json();
    object.update({{"file", file},
                   {"published", end.published},
                   {"topics", end.topics},
                   {"duration_s", end.duration_s}});
    console.print(object);
  } else {
    fmt::print("{} messages of {} topics played in {:.1f} s\n", end.published, end.topics,
               end.duration_s);
  }
  return kDone;
}

int run_replay(const ReplayCall& o, const Console& console) {
  const std::string& file = o.replay.file;
  const auto say = [&](const std::string& sentence) { console.say(sentence); };
  auto reader = recording::Reader::open(file);
  if (!reader) return console.not_done(reader.error());
  const auto& complaints = reader->complaints();
  if (reader->message_count() == 0 && !complaints.empty()) {
    return console.not_done({ErrorCode::invalid_input,
                             fmt::format("no message of {} can be read: {}", file, complaints[0])});
  }
  for (const auto& complaint : complaints) say(file + ": " + complaint);
  if (o.list) return list_recording(*reader, file, console);
  const auto channels = recording::choose_channels(*reader, o.replay, say);
  if (!channels) return console.failed(channels.error());
  if (o.print) {
    const auto printed = recording::print_messages(*reader, *channels);
    return printed ? kDone : console.not_done(printed.error());
  }
  const auto end = recording::replay(*reader, *channels, o.replay, say);
  return end ? tell(*end, file, console) : console.failed(end.error());
}

void add_times(const Verb& verb, recording::ReplayOptions& r) {
  verb->add_option("-r,--rate", r.rate, "times as fast as it was")
      ->capture_default_str()
      ->check(CLI::Range(1e-3, 1e3));
  verb->add_option("--start-offset", r.start_offset_s, "[s] leave out the beginning")
      ->capture_default_str()
      ->check(CLI::Range(0.0, 1e9));
  verb->add_flag("-l,--loop", r.loop, "again and again, until Ctrl-C");
  verb->add_flag("--clock", r.clock, "publish the recording's time on /clock, at 100 Hz");
  verb->add_flag("--restamp", r.restamp,
                 "move the stamps inside of messages to now: a request that is played again "
                 "counts as new, with its whole deadline");
  verb->add_option("--wait", r.wait_s, "[s] longest wait for readers before the start")
      ->capture_default_str()
      ->check(CLI::Range(0.0, 1e4));
  verb->add_flag("--hold", r.hold, "stay after the end, so that latched topics can be read");
}

void add_file(const Verb& verb, recording::ReplayOptions& r) {
  verb->add_option("file", r.file, "an MCAP recording, or a folder with one (of rosbag2, too)")
      ->required();
}

}  // namespace

void add_replay(Program& program) {
  describe_replay(program.verb("replay", "play a recording over DDS, or list what is in it"));
}

void describe_replay(const Verb& verb) {
  auto o = std::make_shared<ReplayCall>();
  auto& r = o->replay;
  add_file(verb, r);
  verb->add_option("-t,--topics", r.topics, "names, or beginnings like /uav1/* (default: all)");
  add_times(verb, r);
  verb->add_option("--lock-step", r.lock_step,
                   "nodes that run with lock_step: true: they are given the recorded turns, so "
                   "that each takes the same messages at the same time as in the recording")
      ->expected(1, -1);
  verb->add_option("--plant", r.plant,
                   "the node that led the recording, if it is to be given turns as well, by /clock");
  verb->add_option("--prefix", r.prefix, "before every topic, as in /replay");
  verb->add_flag("--list", o->list, "only say what is in the file");
  verb->add_flag("--print", o->print, "only print the messages, a line of JSON each");
  verb->footer(
      fmt::format("Examples:\n"
                  "  goshawk {0} flight.mcap --list\n"
                  "  goshawk {0} flight.mcap --rate 0.5 --loop --clock\n"
                  "  goshawk {0} flight.mcap --topics /plan_request /map/* --restamp",
                  verb.path()));
  verb.runs([o](const Console& console) { return run_replay(*o, console); });
}

void describe_recording_info(const Verb& verb) {
  auto o = std::make_shared<ReplayCall>();
  o->list = true;
  add_file(verb, o->replay);
  verb->footer(fmt::format("Example:\n  goshawk {} flight.mcap", verb.path()));
  verb.runs([o](const Console& console) { return run_replay(*o, console); });
}

}  // namespace goshawk::cli
