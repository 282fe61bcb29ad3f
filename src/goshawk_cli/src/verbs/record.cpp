#include "goshawk/recording_tools/record.hpp"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include "goshawk/introspection/interruptible.hpp"
#include "process.hpp"
#include "verbs/verbs.hpp"

namespace goshawk::cli {
namespace {

struct RecordCall {
  recording::RecordOptions record;
  bool stop_with_parent = false;
  int parent = 0;  // its process id, if it is known
};

Json end_json(const recording::RecordEnd& end, const std::string& file) {
  Json topics = Json::array();
  for (const auto& [name, count] : end.received) {
    topics.push_back({{"name", name}, {"received", count}});
  }
  return {{"ok", end.state.ok()},
          {"code", to_string(end.state.code())},
          {"message", end.state ? "" : end.state.error().message},
          {"file", file},
          {"messages", end.counts.messages},
          {"lost", end.counts.lost},
          {"bytes", end.counts.bytes},
          {"duration_s", end.duration_s},
          {"topics", topics}};
}

int tell(const recording::RecordEnd& end, const std::string& file, const Console& console) {
  if (console.json()) {
    console.print(end_json(end, file));
    return end.state ? kDone : kNotDone;
  }
  fmt::print("{}: {} messages of {} topics, {:.1f} MB, {:.1f} s\n", file, end.counts.messages,
             end.received.size(), double(end.counts.bytes) * 1e-6, end.duration_s);
  std::fflush(stdout);
  if (end.state) return kDone;
  return console.not_done(
      {end.state.code(),
       fmt::format("{}. Recording stopped; {} messages before are in the file and readable, the "
                   "last {} are not",
                   end.state.error().message, end.counts.messages, end.counts.lost)});
}

int run_record(RecordCall o, const Console& console) {
  const introspection::Interruptible interruptible;
  if (o.stop_with_parent) stop_with_parent(o.parent);
  if (o.record.file.empty()) {
    o.record.file =
        fmt::format("recording_{:%Y-%m-%d_%H-%M-%S}.mcap", fmt::localtime(std::time(nullptr)));
  }
  const auto end = recording::record(
      o.record, [&](const std::string& sentence) { console.say(sentence); });
  return end ? tell(*end, o.record.file, console) : console.failed(end.error());
}

}  // namespace

void add_record(Program& program) {
  describe_record(program.verb("record", "record topics to an MCAP file, until Ctrl-C"));
}

void describe_record(const Verb& verb) {
  auto o = std::make_shared<RecordCall>();
  auto& r = o->record;
  verb.completes(
      verb->add_option("topics", r.topics, "names, or beginnings like /uav1/* (default: all)"),
      topic_names);
  verb->add_option("-o,--output", r.file, "file (default recording_DATE.mcap)");
  auto* exclude =
      verb->add_option("-x,--exclude", r.exclude, "topic not to record; may repeat")->expected(1);
  verb.completes(exclude, topic_names);
  verb->add_flag("--overwrite", r.overwrite, "replace the file if it exists");
  verb->add_option("-d,--duration", r.duration_s, "[s] end by itself after this time")
      ->check(CLI::Range(0.0, 1e9));
  verb->add_flag("--lock-step", r.lock_step,
                 "take turns as node goshawk_record: name it last in the plant's lock_step_nodes, "
                 "and no message is lost; times are simulated");
  verb->add_flag("--stop-with-parent", o->stop_with_parent,
                 "end as on Ctrl-C when the process that started this one ends");
  verb->add_option("--parent", o->parent)->group("");
  verb->footer(
      "What is recorded is in the file within a second, and stays readable whatever happens to\n"
      "this process. Foxglove and ROS 2's tools open the file.\n\n"
      "Examples:\n" +
      fmt::format("  goshawk {0}\n"
                  "  goshawk {0} /odom /uav1/* -o odom.mcap --duration 60\n"
                  "  goshawk {0} -x /map/voxels",
                  verb.path()));
  verb.runs([o](const Console& console) { return run_record(*o, console); });
}

}  // namespace goshawk::cli
