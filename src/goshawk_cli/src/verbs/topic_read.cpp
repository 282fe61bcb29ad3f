#include <fmt/format.h>

#include <cstdio>
#include <optional>

#include "goshawk/introspection/codec.hpp"
#include "goshawk/introspection/field_path.hpp"
#include "goshawk/introspection/meters.hpp"
#include "goshawk/introspection/text.hpp"
#include "goshawk/introspection/topic_reader.hpp"
#include "verbs/topic.hpp"

namespace goshawk::cli {
namespace {

using introspection::RawMessage;
using introspection::ReadOptions;
using introspection::TopicListener;
using introspection::Window;

int read(const ReadOptions& options, TopicListener listener, const Console& console) {
  auto session = introspection::Session::open();
  if (!session) return console.failed(session.error());
  listener.note = [&](const std::string& sentence) { console.say(sentence); };
  const auto status = introspection::read_topic(**session, options, listener);
  return status ? kDone : console.failed(status.error());
}

struct EchoOptions {
  ReadOptions read;
  bool once = false;
  bool short_arrays = false;
  bool csv = false;
  std::string field;  // empty: the whole message
};

/// A message, or the part of it that was asked for. @param type of that part, if it is a structure
std::string part_as_text(const introspection::Type* type, const Json& part, bool csv) {
  if (csv) return introspection::to_csv(part) + "\n";
  if (type != nullptr) return introspection::to_yaml(*type, part) + "---\n";
  return (part.is_string() ? part.get<std::string>() : introspection::to_line(part)) + "\n---\n";
}

void print_message(const introspection::FieldPath& path, const Json& message, const EchoOptions& o,
                   const Console& console) {
  const Json* found = path.find(message);
  if (found == nullptr) return console.say(o.field + ": this message's list is too short");
  Json part = *found;
  if (o.short_arrays) introspection::shorten_arrays(part);
  if (console.json()) return console.print_line(part);
  fmt::print("{}", part_as_text(path.type(), part, o.csv));
  std::fflush(stdout);
}

int echo(EchoOptions o, const Console& console) {
  if (o.once) o.read.count = 1;
  o.read.newest = o.once;
  o.read.patient = o.read.count == 0;
  const introspection::Type* type = nullptr;
  std::optional<introspection::FieldPath> path;
  TopicListener listener;
  listener.begin = [&](const std::string& name) -> Status {
    auto found = introspection::find_type(name);
    if (!found) {
      return fail(ErrorCode::invalid_parameter,
                  found.error().message + " (hz and bw work with any)");
    }
    type = *found;
    auto parsed = introspection::FieldPath::parse(*type, o.field);
    if (!parsed) return parsed.error();
    path = *std::move(parsed);
    return success();
  };
  listener.message = [&](const RawMessage& message) {
    auto json = introspection::cdr_to_json(*type, message.bytes);
    if (json) {
      print_message(*path, *json, o, console);
    } else {
      console.say(json.error().message);
    }
    return std::ferror(stdout) == 0;  // the reader of a pipe may be gone
  };
  return read(o.read, listener, console);
}

struct MeterOptions {
  ReadOptions read;
  int window = 10000;
};

/// Reports about once a second, and at the end.
template <typename Meter>
int measure(const MeterOptions& o, const Console& console,
            void (*report)(const Meter&, const Console&), TopicListener listener = {}) {
  Meter meter{std::size_t(o.window)};
  bool any = false;
  listener.message = [&](const RawMessage& message) {
    any = true;
    meter.add(message);
    return true;
  };
  listener.tick = [&] { report(meter, console); };
  const int status = read(o.read, listener, console);
  if (any) report(meter, console);
  return status;
}

void print_line(const std::string& line) {
  fmt::print("{}\n", line);
  std::fflush(stdout);
}

void report_rate(const introspection::RateMeter& meter, const Console& console) {
  const auto rate_hz = meter.rate_hz();
  if (!rate_hz) return;
  const Window& w = meter.periods_s;
  if (console.json()) {
    return console.print_line({{"rate_hz", *rate_hz},
                               {"min_s", w.min()},
                               {"max_s", w.max()},
                               {"deviation_s", w.deviation()},
                               {"window", w.size() + 1}});
  }
  print_line(fmt::format(
      "average rate: {:.3f} Hz  min: {:.6f} s  max: {:.6f} s  deviation: {:.6f} s  window: {}",
      *rate_hz, w.min(), w.max(), w.deviation(), w.size() + 1));
}

void report_delay(const introspection::DelayMeter& meter, const Console& console) {
  const Window& w = meter.delays_s;
  if (w.empty()) return;
  if (console.json()) {
    return console.print_line({{"mean_s", w.mean()},
                               {"min_s", w.min()},
                               {"max_s", w.max()},
                               {"deviation_s", w.deviation()},
                               {"window", w.size()}});
  }
  print_line(fmt::format(
      "average delay: {:.6f} s  min: {:.6f} s  max: {:.6f} s  deviation: {:.6f} s  window: {}",
      w.mean(), w.min(), w.max(), w.deviation(), w.size()));
}

void report_bandwidth(const introspection::BandwidthMeter& meter, const Console& console) {
  const Window& w = meter.sizes_byte;
  if (w.empty()) return;
  if (console.json()) {
    return console.print_line({{"bytes_per_s", meter.bytes_per_s()},
                               {"mean_bytes", w.mean()},
                               {"min_bytes", w.min()},
                               {"max_bytes", w.max()},
                               {"window", w.size()}});
  }
  print_line(
      fmt::format("{:.1f} KB/s from {} messages  mean: {:.0f} B  min: {:.0f} B  max: {:.0f} B",
                  meter.bytes_per_s() / 1e3, w.size(), w.mean(), w.min(), w.max()));
}

CLI::Option* add_topic_name(const Verb& verb, ReadOptions& o) {
  auto* option = verb->add_option("topic", o.topic, "its name")->required();
  verb.completes(
      option, [](const Words& before) { return before.empty() ? topic_names(before) : Words(); });
  return option;
}

CLI::Option* add_count(const Verb& verb, ReadOptions& o) {
  return verb->add_option("-n", o.count, "that many messages, then end")
      ->check(CLI::Range(1, 1'000'000'000));
}

void add_meter(const Verb& topic, const std::string& name, const std::string& summary,
               int (*run)(const MeterOptions&, const Console&)) {
  const Verb verb = topic.word(name, summary);
  auto o = std::make_shared<MeterOptions>();
  add_topic_name(verb, o->read);
  verb->add_option("-w,--window", o->window, "newest messages that count")
      ->check(CLI::Range(2, 10'000'000))
      ->capture_default_str();
  add_count(verb, o->read);
  add_timeout(verb, o->read.timeout_s);
  verb->footer(fmt::format("Example:\n  goshawk topic {} /odom -n 500", name));
  verb.runs([o, run](const Console& console) { return run(*o, console); });
}

}  // namespace

void add_topic_echo(const Verb& topic) {
  const Verb verb = topic.word("echo", "print messages");
  auto o = std::make_shared<EchoOptions>();
  add_topic_name(verb, o->read);
  auto* once = verb->add_flag("--once", o->once, "one message, then end; of a latched topic the newest");
  add_count(verb, o->read)->excludes(once);
  auto* short_arrays =
      verb->add_flag("--no-arr", o->short_arrays, "long lists as their length");
  verb->add_option("--field", o->field, "only this part, as pose.pose.position or polytopes[0].b");
  verb->add_flag("--csv", o->csv, "the values of a message in a line, with commas between")
      ->excludes(short_arrays);
  add_timeout(verb, o->read.timeout_s);
  verb->footer(
      "Examples:\n"
      "  goshawk topic echo /stage_report\n"
      "  goshawk topic echo /map/voxels --once --no-arr\n"
      "  goshawk topic echo /odom --field pose.pose.position --csv -n 100 > track.csv\n"
      "  goshawk topic echo /odom --json -n 100 > odom.jsonl");
  verb.runs([o](const Console& console) { return echo(*o, console); });
}

void add_topic_meters(const Verb& topic) {
  add_meter(topic, "hz", "rate at which messages come",
            [](const MeterOptions& o, const Console& c) { return measure(o, c, report_rate); });
  add_meter(topic, "delay", "time from the header's stamp to the arrival here",
            [](const MeterOptions& o, const Console& c) {
              TopicListener listener;
              listener.begin = introspection::DelayMeter::check;
              return measure(o, c, report_delay, listener);
            });
  add_meter(topic, "bw", "bytes a second", [](const MeterOptions& o, const Console& c) {
    return measure(o, c, report_bandwidth);
  });
}

}  // namespace goshawk::cli
