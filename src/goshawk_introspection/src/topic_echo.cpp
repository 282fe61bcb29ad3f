#include <iostream>

#include "goshawk/introspection/codec.hpp"
#include "text.hpp"
#include "topic_reader.hpp"
#include "topic_verbs.hpp"

namespace goshawk::introspection {
namespace {

struct EchoOptions {
  ReadOptions read;
  bool once = false;
  bool short_arrays = false;
};

void print(const Type& type, nlohmann::ordered_json message, const EchoOptions& options,
           bool as_json) {
  if (options.short_arrays) shorten_arrays(message);
  std::cout << (as_json ? to_line(message) + "\n" : to_yaml(type, message) + "---\n") << std::flush;
}

int echo(const CommonOptions& common, EchoOptions options) {
  if (options.once) options.read.count = 1;
  options.read.patient = options.read.count == 0;
  const Type* type = nullptr;
  return read_topic(
      common, options.read,
      [&](const std::string& name) {
        auto found = find_type(name);
        if (!found) return say_wrong_call(found.error().message + " (hz and bw work with any)");
        type = *found;
        return 0;
      },
      [&](const RawMessage& message) {
        auto json = cdr_to_json(*type, message.bytes);
        if (json) {
          print(*type, *std::move(json), options, common.json);
        } else {
          std::cerr << "goshawk: " << json.error().message << std::endl;
        }
        return bool(std::cout);  // the reader of a pipe may be gone
      },
      [] {});
}

}  // namespace

Verb topic_echo_verb() {
  return {"echo", "prints messages", [](CLI::App& app, CommonOptions& common) {
            auto options = std::make_shared<EchoOptions>();
            app.add_option("topic", options->read.topic, "its name")->required();
            auto* once = app.add_flag("--once", options->once, "one message, then end");
            app.add_option("-n", options->read.count, "that many messages, then end")
                ->check(CLI::Range(1, 1'000'000'000))
                ->excludes(once);
            app.add_flag("--no-arr", options->short_arrays, "long lists as their length");
            app.footer(
                "Examples:\n"
                "  goshawk topic echo /stage_report\n"
                "  goshawk topic echo /map/voxels --once --no-arr\n"
                "  goshawk topic echo /odom --json -n 100 > odom.jsonl");
            return [&common, options] { return echo(common, *options); };
          }};
}

}  // namespace goshawk::introspection
