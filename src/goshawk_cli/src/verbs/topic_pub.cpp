#include <fmt/format.h>
#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <optional>

#include "goshawk/introspection/topic_writer.hpp"
#include "verbs/topic.hpp"

namespace goshawk::cli {
namespace {

using introspection::Interruptible;
using introspection::Session;
using introspection::TopicWriter;
using Bytes = std::vector<unsigned char>;

struct PubOptions {
  std::string topic;
  std::string type;
  std::string message = "{}";
  bool once = false;
  int count = 0;  // 0: until Ctrl-C
  double rate_hz = 1.0;
  int readers = 1;  // that are waited for before the first message
  double timeout_s = 2.0;

  double arrival_s() const { return std::max(1.0, timeout_s); }
};

void tell(const TopicWriter& writer, int published, int subscribers, const Console& console) {
  if (!console.json()) return;
  console.print_line({{"topic", writer.topic()},
                      {"type", writer.type()},
                      {"published", published},
                      {"subscribers", subscribers}});
}

/// The same message, again and again.
int publish_all(Session& session, TopicWriter& writer, const Bytes& bytes, const PubOptions& o,
                const Console& console) {
  int published = 0;
  Status state = success();
  const auto publish = [&] {
    state = writer.publish(bytes);
    ++published;
  };
  publish();
  // A reader that was found may not have found this writer yet: the second message waits for that.
  if (o.count > 1 && state) (void)writer.wait_arrival(o.arrival_s());
  int subscribers = writer.readers();
  session.node().every(1.0 / o.rate_hz, [&] {
    if (o.count == 0 || published < o.count) publish();
    subscribers = writer.readers();
  });
  while (state && !Interruptible::interrupted() && (o.count == 0 || published < o.count)) {
    session.node().spin_some(0.1);
  }
  if (!state) return console.failed(state.error());
  // What is on its way must arrive before the writer goes.
  const auto arrived = writer.wait_arrival(o.arrival_s());
  tell(writer, published, subscribers, console);
  return arrived ? kDone : console.failed(arrived.error());
}

/// Lines of standard input.
class Lines {
 public:
  /// @return the next one; none at the end of the input, or on Ctrl-C
  std::optional<std::string> next() {
    for (;;) {
      if (const auto end = text_.find('\n'); end != std::string::npos) return cut(end);
      if (Interruptible::interrupted()) return {};
      pollfd input{STDIN_FILENO, POLLIN, 0};
      if (poll(&input, 1, 100) <= 0) continue;
      char buffer[1 << 16];
      const auto got = ::read(STDIN_FILENO, buffer, sizeof buffer);
      if (got > 0) {
        text_.append(buffer, std::size_t(got));
      } else if (got == 0 || errno != EINTR) {
        if (text_.empty()) return {};
        return cut(text_.size());  // the last one needs no end
      }
    }
  }

 private:
  std::string cut(std::size_t end) {
    std::string line = text_.substr(0, end);
    text_.erase(0, end + 1);
    return line;
  }
  std::string text_;
};

/// A message a line, each once the one before has arrived.
int publish_lines(TopicWriter& writer, const PubOptions& o, const Console& console) {
  Lines lines;
  int published = 0;
  while (const auto line = lines.next()) {
    if (line->find_first_not_of(" \t\r") == std::string::npos) continue;
    const auto bytes = TopicWriter::encode(o.type, *line);
    if (!bytes) return console.failed(bytes.error());
    if (writer.readers() < o.readers) {
      const auto found = writer.wait_for_readers(o.readers, o.timeout_s);
      if (found.code() == ErrorCode::cancelled) break;
      if (!found) return console.failed(found.error());
    }
    const int subscribers = writer.readers();
    if (auto status = writer.publish(*bytes); !status) return console.failed(status.error());
    const auto arrived = writer.wait_arrival(o.arrival_s());
    tell(writer, ++published, subscribers, console);
    if (!arrived) return console.failed(arrived.error());
  }
  return kDone;
}

int publish_message(Session& session, TopicWriter& writer, const Bytes& bytes, const PubOptions& o,
                    const Console& console) {
  // What is said only once must reach all who read, not only the first that was met.
  if (o.count > 0) {
    const auto found = writer.wait_for_readers(o.readers, o.timeout_s);
    if (found.code() == ErrorCode::cancelled) return kDone;
    if (!found) return console.failed(found.error());
  } else if (!session.wait_for(o.timeout_s, [&] { return writer.readers() >= o.readers; })) {
    if (Interruptible::interrupted()) return kDone;
    console.say(
        fmt::format("{} of {} readers of {} so far", writer.readers(), o.readers, writer.topic()));
  }
  return publish_all(session, writer, bytes, o, console);
}

int pub(PubOptions o, const Console& console) {
  if (o.once) o.count = 1;
  const bool from_input = o.message == "-";
  const auto bytes = TopicWriter::encode(o.type, from_input ? "{}" : o.message);
  if (!bytes) return console.failed(bytes.error());
  if (auto name = introspection::full_topic_name(o.topic); !name)
    return console.failed(name.error());
  auto session = Session::open();
  if (!session) return console.failed(session.error());
  auto writer = TopicWriter::open(**session, o.topic, o.type);
  if (!writer) return console.failed(writer.error());
  if (from_input) return publish_lines(*writer, o, console);
  return publish_message(**session, *writer, *bytes, o, console);
}

}  // namespace

void add_topic_pub(const Verb& topic) {
  const Verb verb = topic.word("pub", "publish a message, again and again");
  auto o = std::make_shared<PubOptions>();
  auto* name = verb->add_option("topic", o->topic, "its name")->required();
  verb.completes(name, topic_names);
  auto* type = verb->add_option("type", o->type, "as goshawk_msgs/msg/Path")->required();
  verb.completes(type, type_names);
  verb->add_option("message", o->message,
                   "JSON or YAML; fields left out are zero or empty. -: a message a line, from "
                   "standard input");
  auto* once = verb->add_flag("--once,-1", o->once, "once, then end");
  verb->add_option("-n,--times", o->count, "that many times, then end")
      ->check(CLI::Range(1, 1'000'000'000))
      ->excludes(once);
  verb->add_option("-w,--wait-matching-subscriptions", o->readers,
                   "wait for so many readers first: a recorder comes after the writer")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  verb->add_option("-r,--rate", o->rate_hz, "[Hz]")
      ->check(CLI::Range(1e-3, 1e5))
      ->capture_default_str();
  add_timeout(verb, o->timeout_s);
  verb->footer(
      "Examples:\n"
      "  goshawk topic pub /goal_pose geometry_msgs/msg/PoseStamped \\\n"
      "    \"{header: {frame_id: map}, pose: {position: {x: 3, y: 8, z: 2}, orientation: "
      "{w: 1}}}\" --once");
  verb.runs([o](const Console& console) { return pub(*o, console); });
}

}  // namespace goshawk::cli
