#include "verb.hpp"

#include <signal.h>

#include <algorithm>
#include <atomic>
#include <cstdio>

#include "goshawk/runtime/ros_args.hpp"

namespace goshawk::recording {
namespace {

std::atomic<bool> g_interrupted = false;  // signal handlers reach nothing else
struct sigaction g_old_int, g_old_term, g_old_size;

}  // namespace

std::optional<int> parse(CLI::App& app, std::vector<std::string> arguments) {
  const bool json = std::ranges::find(arguments, "--json") != arguments.end();
  std::ranges::reverse(arguments);  // CLI11 takes them from the back
  try {
    app.parse(arguments);
  } catch (const CLI::ParseError& error) {
    if (json && error.get_exit_code() != 0) {
      return report_failure("", fail(ErrorCode::invalid_parameter, error.what()), true, kWrongCall);
    }
    return app.exit(error) == 0 ? kDone : kWrongCall;
  }
  return {};
}

void print_json(const Json& object) {
  std::printf("%s\n", object.dump(2, ' ', false, Json::error_handler_t::replace).c_str());
  std::fflush(stdout);
}

int report_failure(const std::string& verb, const Error& error, bool json, int status) {
  const std::string code(to_string(error.code));
  if (json) {
    print_json({{"ok", false}, {"code", code}, {"message", error.message}});
  } else {
    say(verb, code + ": " + error.message);
  }
  return status;
}

void say(const std::string& verb, const std::string& sentence) {
  std::fprintf(stderr, "goshawk %s: %s\n", verb.c_str(), sentence.c_str());
}

Interruptible::Interruptible() {
  g_interrupted = false;
  struct sigaction action {};
  action.sa_handler = [](int) { g_interrupted = true; };
  sigemptyset(&action.sa_mask);
  sigaction(SIGINT, &action, &g_old_int);
  sigaction(SIGTERM, &action, &g_old_term);
  action.sa_handler = SIG_IGN;
  sigaction(SIGXFSZ, &action, &g_old_size);
}

Interruptible::~Interruptible() {
  sigaction(SIGINT, &g_old_int, nullptr);
  sigaction(SIGTERM, &g_old_term, nullptr);
  sigaction(SIGXFSZ, &g_old_size, nullptr);
}

bool Interruptible::interrupted() {
  return g_interrupted;
}

Result<std::unique_ptr<runtime::Context>> join_domain() {
  auto options = runtime::ContextOptions::from_environment();
  if (!options) return options.error();
  return runtime::Context::create(*options);
}

Result<std::string> full_topic_name(const std::string& topic) {
  const std::string full = topic.starts_with('/') ? topic : "/" + topic;
  const bool open = full.ends_with('*');
  const std::string name = open ? full.substr(0, full.find_last_not_of("*/") + 1) : full;
  if (open && name.empty()) return full;
  if (auto status = runtime::check_topic_name(name); !status) return status.error();
  return full;
}

bool matches(const std::vector<std::string>& patterns, const std::string& topic) {
  return std::ranges::any_of(patterns, [&](const std::string& pattern) {
    if (!pattern.ends_with('*')) return pattern == topic;
    return topic.starts_with(pattern.substr(0, pattern.size() - 1));
  });
}

}  // namespace goshawk::recording
