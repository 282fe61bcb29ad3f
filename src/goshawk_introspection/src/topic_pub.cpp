#include <iostream>

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
};

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
  if (common.json) {
    std::cout << to_line({{"topic", options.topic},
                          {"type", options.type},
                          {"published", published},
                          {"subscribers", subscribers}})
              << std::endl;
  }
  if (failed) return kNothing;
  if (!arrived) return say_nothing("a subscriber did not confirm the last message");
  return 0;
}

int pub(const CommonOptions& common, PubOptions options) {
  if (options.once) options.count = 1;
  auto name = full_topic_name(options.topic);
  if (!name) return say_wrong_call(name.error().message);
  auto type = find_type(options.type);
  if (!type) return say_wrong_call(type.error().message);
  auto json = parse_json_or_yaml(options.message);
  if (!json) return say_wrong_call(json.error().message);
  auto bytes = json_to_cdr(**type, *json);
  if (!bytes) return say_wrong_call(bytes.error().message);

  auto session = Session::open();
  if (!session) return say_wrong_call(session.error().message);
  options.topic = *name;
  options.type = std::string((*type)->name);
  // Reliable and latched matches every reader, whatever it asks for.
  const auto raw = runtime::raw_message_type(runtime::wire_type_name(options.type));
  const auto publisher = (*session)->node().advertise_raw(*name, raw, runtime::Qos::latched(1));
  const bool heard =
      (*session)->wait_for(common.timeout_s, [&] { return publisher.matched() > 0; });
  if (Interruptible::interrupted()) return 0;
  if (!heard && options.count > 0) {
    const int status = (*session)->say_no_reader(*name, options.type);
    return status;
  }
  // All who read, not only the first that was met, get what is said only once.
  if (options.count > 0) (*session)->settle(common.timeout_s, [&] { return publisher.matched(); });
  if (!heard) std::cerr << "goshawk: nobody reads " << *name << " so far" << std::endl;
  return publish_all(**session, publisher, *bytes, options, common);
}

}  // namespace

Verb topic_pub_verb() {
  return {"pub", "publishes a message, again and again", [](CLI::App& app, CommonOptions& common) {
            auto options = std::make_shared<PubOptions>();
            app.add_option("topic", options->topic, "its name")->required();
            app.add_option("type", options->type, "as goshawk_msgs/msg/Path")->required();
            app.add_option("message", options->message,
                           "JSON or YAML; fields left out are zero or empty");
            auto* once = app.add_flag("--once,-1", options->once, "once, then end");
            app.add_option("-n,--times", options->count, "that many times, then end")
                ->check(CLI::Range(1, 1'000'000'000))
                ->excludes(once);
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
