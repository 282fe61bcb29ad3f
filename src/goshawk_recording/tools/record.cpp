#include "goshawk/recording_tools/record.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <thread>

#include "goshawk/introspection/session.hpp"
#include "recorder.hpp"

namespace goshawk::recording {
namespace {

using introspection::Interruptible;

constexpr double kLookPeriod_s = 0.05;  // for new topics
constexpr double kQuiet_s = 1.0;        // no new topic for this long: all have been found
constexpr double kNothing_s =
    30.0;  // simulated time does not wait longer for topics that never come
constexpr double kFlushPeriod_s = 1.0;  // most that kill -9 may lose

/// Real time, even if messages have simulated time.
class Stopwatch {
 public:
  double seconds() const { return std::chrono::duration<double>(Clock::now() - begin_).count(); }
  /// @return whether period_s is over; then it starts over
  bool lap(double period_s) {
    if (seconds() < period_s) return false;
    begin_ = Clock::now();
    return true;
  }

 private:
  using Clock = std::chrono::steady_clock;
  Clock::time_point begin_ = Clock::now();
};

Result<std::vector<std::string>> complete_names(std::vector<std::string> names) {
  for (auto& name : names) {
    auto full = introspection::full_topic_pattern(name);
    if (!full) return full.error();
    name = *full;
  }
  return names;
}

Result<std::unique_ptr<runtime::Context>> join_domain() {
  auto options = runtime::ContextOptions::from_environment();
  if (!options) return options.error();
  return runtime::Context::create(*options);
}

// In lock step simulated time waits until this node has answered its first turn, which it does
// after it has joined every topic.
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

// Until Ctrl-C, the end of the time, or a failure to write.
void take_all(runtime::Node& node, Recorder& recorder, double duration_s, const Stopwatch& whole) {
  Stopwatch looked, flushed;
  recorder.join();
  while (recorder.state() && !Interruptible::interrupted() &&
         (duration_s <= 0.0 || whole.seconds() < duration_s)) {
    node.spin_some(kLookPeriod_s);
    if (looked.lap(kLookPeriod_s)) recorder.join();
    if (flushed.lap(kFlushPeriod_s)) (void)recorder.flush();
  }
  for (int k = 0; k < 4 && recorder.state(); ++k)
    node.spin_some(0.0);  // messages that have already arrived
}

}  // namespace

Result<RecordEnd> record(const RecordOptions& o, const Say& say) {
  auto topics = complete_names(o.topics);
  if (!topics) return topics.error();
  auto exclude = complete_names(o.exclude);
  if (!exclude) return exclude.error();
  const Interruptible interruptible;
  auto sink = create_file(o.file, o.overwrite);
  if (!sink) return sink.error();
  auto writer = Writer::create(*std::move(sink));
  if (!writer) return writer.error();
  auto context = join_domain();
  if (!context) return context.error();
  runtime::Node node(**context, "goshawk_record");
  if (o.lock_step) node.run_in_lock_step();
  Recorder recorder(**context, node, *std::move(writer),
                    {*std::move(topics), *std::move(exclude), say});
  say(fmt::format("recording to {}{}", o.file, o.duration_s > 0.0 ? "" : ", until Ctrl-C"));
  const Stopwatch whole;
  if (o.lock_step) join_all(**context, node.full_name() + "/turn", recorder, o.duration_s);
  take_all(node, recorder, o.duration_s, whole);
  const auto closed = recorder.close();
  return RecordEnd{closed, recorder.counts(), recorder.received(), whole.seconds()};
}

}  // namespace goshawk::recording
