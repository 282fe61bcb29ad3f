#include <poll.h>
#include <unistd.h>

#include <iostream>
#include <optional>

#include "goshawk/introspection/codec.hpp"
#include "goshawk/runtime/message_type.hpp"
#include "text.hpp"
#include "topic_verbs.hpp"

namespace goshawk::introspection {
namespace {

struct PubOptions {
  std::string topic;
  std::string type;
  std::string message = "{}";
  bool once = false;
  int count = 0;  // 0: until Ctrl-C
  double rate_hz = 1.0;
  int readers = 1;  // that are waited for before the first message
};

int say_published(const PubOptions& options, const CommonOptions& common, int published,
                  int subscribers, bool arrived) {
  if (common.json) {
    std::cout << to_line({{"topic", options.topic},
                          {"type", options.type},
                          {"published", published},
                          {"subscribers", subscribers}})
              << std::endl;
  }
  return arrived ? 0 : say_nothing("a subscriber did not confirm the last message");
}

// @return exit status
int publish_all(Session& session, const runtime::RawPublisher& publisher,
                const std::vector<unsigned char>& bytes, const PubOptions& options,
                const CommonOptions& common) {
  int published = 0;
  bool failed = false;
  const auto publish = [&] {
    if (auto status = publisher.publish_raw(&bytes); !status) {
      failed = true;
      say_nothing(status.error().message);
    }
    ++published;
  };
  publish();
  int subscribers = publisher.matched();
  session.node().every(1.0 / options.rate_hz, [&] {
    if (options.count == 0 || published < options.count) publish();
    subscribers = publisher.matched();
  });
  while (!failed && !Interruptible::interrupted() &&
         (options.count == 0 || published < options.count)) {
    session.node().spin_some(0.1);
  }
  // What is on its way must arrive before the writer goes.
  const bool arrived = publisher.wait_acknowledged(std::max(1.0, common.timeout_s));
  const int status = say_published(options, common, published, subscribers, arrived);
  return failed ? kNothing : status;
}

/// Lines of standard input.
class Lines {
 public:
  /// @return the next one; none where the input ended, or Ctrl-C did
  std::optional<std::string> next() {
    for (;;) {
      if (const auto end = text_.find('\n'); end != std::string::npos) return cut(end);
      if (Interruptible::interrupted()) return {};
      pollfd input{STDIN_FILENO, POLLIN, 0};
      if (poll(&input, 1, 100) <= 0) continue;
      char buffer[1 << 16];
      const auto got = read(STDIN_FILENO, buffer, sizeof buffer);
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

Result<std::vector<unsigned char>> encoded(const Type& type, const std::string& message) {
  auto json = parse_json_or_yaml(message);
  if (!json) return json.error();
  return json_to_cdr(type, *json);
}

// @return exit status
int say_too_few(const Session& session, const runtime::RawPublisher& publisher,
                const PubOptions& options) {
  if (publisher.matched() == 0) return session.say_no_reader(options.topic, options.type);
  return say_nothing("only " + std::to_string(publisher.matched()) + " of " +
                     std::to_string(options.readers) + " readers of " + options.topic +
                     " came, nothing was published");
}

/// A message a line, each once the one before has arrived. @return exit status
int publish_lines(Session& session, const runtime::RawPublisher& publisher, const Type& type,
                  const PubOptions& options, const CommonOptions& common) {
  Lines lines;
  int published = 0;
  while (const auto line = lines.next()) {
    if (line->find_first_not_of(" \t\r") == std::string::npos) continue;
    const auto bytes = encoded(type, *line);
    if (!bytes) return say_wrong_call(bytes.error().message);
    if (publisher.matched() < options.readers) {
      if (!session.wait_for(common.timeout_s,
                            [&] { return publisher.matched() >= options.readers; })) {
        if (Interruptible::interrupted()) break;
        return say_too_few(session, publisher, options);
      }
      session.settle(common.timeout_s, [&] { return publisher.matched(); });
    }
    const int subscribers = publisher.matched();
    if (auto status = publisher.publish_raw(&*bytes); !status) {
      return say_nothing(status.error().message);
    }
    const bool arrived = publisher.wait_acknowledged(std::max(1.0, common.timeout_s));
    const int status = say_published(options, common, ++published, subscribers, arrived);
    if (status != 0) return status;
  }
  return 0;
}

int pub(const CommonOptions& common, PubOptions options) {
  if (options.once) options.count = 1;
  auto name = full_topic_name(options.topic);
  if (!name) return say_wrong_call(name.error().message);
  auto type = find_type(options.type);
  if (!type) return say_wrong_call(type.error().message);
  const bool from_input = options.message == "-";
  const auto bytes = encoded(**type, from_input ? "{}" : options.message);
  if (!bytes) return say_wrong_call(bytes.error().message);

  auto session = Session::open();
  if (!session) return say_wrong_call(session.error().message);
  options.topic = *name;
  options.type = std::string((*type)->name);
  // Reliable and latched matches every reader, whatever it asks for.
  const auto raw = runtime::raw_message_type(runtime::wire_type_name(options.type));
  const auto publisher = (*session)->node().advertise_raw(*name, raw, runtime::Qos::latched(1));
  if (from_input) return publish_lines(**session, publisher, **type, options, common);
  const bool heard = (*session)->wait_for(common.timeout_s,
                                          [&] { return publisher.matched() >= options.readers; });
  if (Interruptible::interrupted()) return 0;
  if (!heard && options.count > 0) return say_too_few(**session, publisher, options);
  // All who read, not only the first that was met, get what is said only once.
  if (options.count > 0) (*session)->settle(common.timeout_s, [&] { return publisher.matched(); });
  if (!heard) {
    std::cerr << "goshawk: " << publisher.matched() << " of " << options.readers << " readers of "
              << *name << " so far" << std::endl;
  }
  return publish_all(**session, publisher, *bytes, options, common);
}

}  // namespace

Verb topic_pub_verb() {
  return {"pub", "publishes a message, again and again", [](CLI::App& app, CommonOptions& common) {
            auto options = std::make_shared<PubOptions>();
            app.add_option("topic", options->topic, "its name")->required();
            app.add_option("type", options->type, "as goshawk_msgs/msg/Path")->required();
            app.add_option("message", options->message,
                           "JSON or YAML; fields left out are zero or empty. -: a message a line, "
                           "from standard input");
            auto* once = app.add_flag("--once,-1", options->once, "once, then end");
            app.add_option("-n,--times", options->count, "that many times, then end")
                ->check(CLI::Range(1, 1'000'000'000))
                ->excludes(once);
            app.add_option("-w,--wait-matching-subscriptions", options->readers,
                           "wait for so many readers first: a recorder comes after the writer")
                ->check(CLI::Range(1, 1000))
                ->capture_default_str();
            app.add_option("-r,--rate", options->rate_hz, "[Hz]")
                ->check(CLI::Range(1e-3, 1e5))
                ->capture_default_str();
            app.footer(
                "Examples:\n"
                "  goshawk topic pub /goal_pose geometry_msgs/msg/PoseStamped \\\n"
                "    \"{header: {frame_id: map}, pose: {position: {x: 3, y: 8, z: 2}, orientation: "
                "{w: 1}}}\" --once");
            return [&common, options] { return pub(common, *options); };
          }};
}

}  // namespace goshawk::introspection
