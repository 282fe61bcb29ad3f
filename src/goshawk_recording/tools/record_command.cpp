#include <signal.h>
#include <sys/prctl.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <ctime>
#include <thread>

#include "goshawk/recording/commands.hpp"
#include "recorder.hpp"
#include "verb.hpp"

namespace goshawk::recording {
namespace {

constexpr double kLookPeriod_s = 0.05;  // for new topics
constexpr double kQuiet_s = 1.0;        // nothing new for so long: all that is there has been found
constexpr double kNothing_s = 30.0;     // the world does not wait longer for topics that never come
constexpr double kFlushPeriod_s = 1.0;  // what kill -9 may cost

struct RecordCall {
  std::vector<std::string> topics;
  std::vector<std::string> exclude;
  std::string file;
  bool overwrite = false;
  double duration_s = 0.0;  // 0: until Ctrl-C
  bool lock_step = false;
  bool stop_with_parent = false;
  int parent = 0;  // its process id, where it is known
  bool json = false;
};

/// The machine's time, also where messages have simulated time.
class Stopwatch {
 public:
  double seconds() const { return std::chrono::duration<double>(Clock::now() - begin_).count(); }
  /// @return whether period_s is over; it begins anew then
  bool lap(double period_s) {
    if (seconds() < period_s) return false;
    begin_ = Clock::now();
    return true;
  }

 private:
  using Clock = std::chrono::steady_clock;
  Clock::time_point begin_ = Clock::now();
};

std::string dated_name() {
  char name[64];
  const std::time_t now = std::time(nullptr);
  std::strftime(name, sizeof name, "recording_%Y-%m-%d_%H-%M-%S.mcap", std::localtime(&now));
  return name;
}

void add_options(CLI::App& app, RecordCall& o) {
  app.add_option("topics", o.topics, "names, or beginnings like /uav1/* (default: all)");
  app.add_option("-o,--output", o.file, "file (default recording_DATE.mcap)");
  app.add_option("-x,--exclude", o.exclude, "topic not to record; may repeat")->expected(1);
  app.add_flag("--overwrite", o.overwrite, "replace the file where it exists");
  app.add_option("-d,--duration", o.duration_s, "[s] end by itself after this time")
      ->check(CLI::Range(0.0, 1e9));
  app.add_flag(
      "--lock-step", o.lock_step,
      "take turns as node goshawk_record: name it last in the plant's lock_step_nodes, and "
      "no message is lost; times are simulated");
  app.add_flag("--stop-with-parent", o.stop_with_parent,
               "end as on Ctrl-C when the process that started this one ends");
  app.add_option("--parent", o.parent)->group("");
  app.add_flag("--json", o.json, "print one JSON object at the end (docs/cli.md)");
  app.footer(
      "Records until Ctrl-C. What is recorded is in the file within a second, and stays readable\n"
      "whatever happens to this process. Foxglove and ROS 2's tools open the file.\n\n"
      "Examples:\n"
      "  goshawk record\n"
      "  goshawk record /odom /uav1/* -o odom.mcap --duration 60\n"
      "  goshawk record -x /map/voxels");
}

Status complete_names(std::vector<std::string>& names) {
  for (auto& name : names) {
    auto full = full_topic_name(name);
    if (!full) return full.error();
    name = *full;
  }
  return success();
}

double megabytes(std::uint64_t bytes) {
  return double(bytes) * 1e-6;
}

void print_end(const Recorder& recorder, const RecordCall& o, double seconds) {
  const auto counts = recorder.counts();
  const auto& state = recorder.state();
  if (o.json) {
    Json topics = Json::array();
    for (const auto& [name, count] : recorder.received()) {
      topics.push_back({{"name", name}, {"received", count}});
    }
    return print_json({{"ok", state.ok()},
                       {"code", to_string(state.code())},
                       {"message", state ? "" : state.error().message},
                       {"file", o.file},
                       {"messages", counts.messages},
                       {"lost", counts.lost},
                       {"bytes", counts.bytes},
                       {"duration_s", seconds},
                       {"topics", topics}});
  }
  std::printf("%s: %llu messages of %zu topics, %.1f MB, %.1f s\n", o.file.c_str(),
              (unsigned long long)counts.messages, recorder.received().size(),
              megabytes(counts.bytes), seconds);
  if (!state) {
    say("record", std::string(to_string(state.code())) + ": " + state.error().message +
                      ". Recording stopped; " + std::to_string(counts.messages) +
                      " messages before are in the file and readable, the last " +
                      std::to_string(counts.lost) + " are not");
  }
}

// In lock step the world stands still until this node has answered its first turn: not before
// every topic that is there has been joined.
void join_all(const runtime::Context& context, const std::string& turns, Recorder& recorder,
              double most_s) {
  const Stopwatch whole;
  Stopwatch led, quiet;
  std::size_t known = 0;
  while (!Interruptible::interrupted() && (most_s <= 0.0 || whole.seconds() < most_s)) {
    recorder.join();
    const bool leader_is_there = std::ranges::any_of(
        context.endpoints(), [&](const auto& e) { return e.writer && e.topic == turns; });
    const std::size_t topics = recorder.received().size();
    if (!leader_is_there) led = {};
    if (!leader_is_there || topics != known) quiet = {};
    known = topics;
    if (quiet.seconds() > kQuiet_s && (topics > 0 || led.seconds() > kNothing_s)) return;
    std::this_thread::sleep_for(std::chrono::duration<double>(kLookPeriod_s));
  }
}

int record(const RecordCall& o) {
  const Interruptible interruptible;
  if (o.stop_with_parent) prctl(PR_SET_PDEATHSIG, SIGINT);
  // It may have ended before this process could ask to be told.
  if (o.stop_with_parent && o.parent != 0 && getppid() != o.parent) raise(SIGINT);
  auto sink = create_file(o.file, o.overwrite);
  if (!sink) return report_failure("record", sink.error(), o.json, kNotDone);
  auto writer = Writer::create(*std::move(sink));
  if (!writer) return report_failure("record", writer.error(), o.json, kNotDone);
  auto context = join_domain();
  if (!context) return report_failure("record", context.error(), o.json, kNotDone);
  runtime::Node node(**context, "goshawk_record");
  if (o.lock_step) node.run_in_lock_step();
  Recorder recorder(**context, node, *std::move(writer), {o.topics, o.exclude});
  say("record", "recording to " + o.file + (o.duration_s > 0.0 ? "" : ", until Ctrl-C"));
  const Stopwatch whole;
  if (o.lock_step) join_all(**context, node.full_name() + "/turn", recorder, o.duration_s);
  Stopwatch looked, flushed;
  recorder.join();
  while (recorder.state() && !Interruptible::interrupted() &&
         (o.duration_s <= 0.0 || whole.seconds() < o.duration_s)) {
    node.spin_some(kLookPeriod_s);
    if (looked.lap(kLookPeriod_s)) recorder.join();
    if (flushed.lap(kFlushPeriod_s)) (void)recorder.flush();
  }
  for (int k = 0; k < 4 && recorder.state(); ++k) node.spin_some(0.0);  // what has come already
  const auto closed = recorder.close();
  print_end(recorder, o, whole.seconds());
  return closed ? kDone : kNotDone;
}

}  // namespace

int record_command(const std::vector<std::string>& arguments) {
  CLI::App app("Record topics of the domain to an MCAP file.", "goshawk record");
  RecordCall o;
  add_options(app, o);
  if (const auto status = parse(app, arguments)) return *status;
  for (auto* names : {&o.topics, &o.exclude}) {
    if (auto fault = complete_names(*names); !fault) {
      return report_failure("record", fault.error(), o.json, kWrongCall);
    }
  }
  if (o.file.empty()) o.file = dated_name();
  return record(o);
}

}  // namespace goshawk::recording
