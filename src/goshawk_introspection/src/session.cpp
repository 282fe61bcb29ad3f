#include "session.hpp"

#include <signal.h>

#include <atomic>
#include <cmath>
#include <iostream>
#include <set>

#include "goshawk/runtime/parameters.hpp"

namespace goshawk::introspection {
namespace {

using Steady = std::chrono::steady_clock;

constexpr double kSlice_s = 0.02;  // how often a wait looks for Ctrl-C
// Participants that miss each other's first announcements meet at the next one, half a second
// later (runtime's Context); their endpoints follow within milliseconds.
constexpr double kSettled_s = 0.7;

std::atomic<bool> g_interrupted = false;  // signal handlers reach nothing else
struct sigaction g_old_int, g_old_term;

double seconds_since(Steady::time_point begin) {
  return std::chrono::duration<double>(Steady::now() - begin).count();
}

std::string usage(const std::string& command, const std::vector<Verb>& verbs) {
  std::string text = "usage: goshawk " + command + " VERB ...\n";
  for (const auto& verb : verbs) {
    text += "  " + verb.name + std::string(10 - std::min<std::size_t>(9, verb.name.size()), ' ') +
            verb.summary + "\n";
  }
  return text + "goshawk " + command + " VERB --help tells more.";
}

}  // namespace

int say_wrong_call(const std::string& sentence) {
  std::cerr << "goshawk: " << sentence << std::endl;
  return kWrongCall;
}

int say_nothing(const std::string& sentence) {
  std::cerr << "goshawk: " << sentence << std::endl;
  return kNothing;
}

int run_one(const std::string& name, const Verb& verb, std::vector<std::string> arguments) {
  CLI::App app(verb.summary, "goshawk " + name);
  CommonOptions common{.timeout_s = verb.timeout_s};
  app.add_flag("--json", common.json, "for programs: one JSON object a line");
  app.add_option("--timeout", common.timeout_s, "longest wait for something to be there [s]")
      ->check(CLI::Range(0.0, 86400.0))
      ->capture_default_str();
  const auto run = verb.prepare(app, common);
  try {
    app.parse(std::vector<std::string>(arguments.rbegin(), arguments.rend()));
  } catch (const CLI::CallForHelp&) {
    std::cout << app.help();
    return 0;
  } catch (const CLI::ParseError& e) {
    return say_wrong_call(name + ": " + e.what() + "\n" + app.help());
  }
  return run();
}

int run_verb(const std::string& command, const std::vector<Verb>& verbs,
             std::vector<std::string> arguments) {
  if (arguments.empty()) return say_wrong_call(usage(command, verbs));
  const std::string wanted = arguments.front();
  if (wanted == "--help" || wanted == "-h") {
    std::cout << usage(command, verbs) << std::endl;
    return 0;
  }
  std::vector<std::string> names;
  for (const auto& verb : verbs) {
    names.push_back(verb.name);
    if (verb.name != wanted) continue;
    return run_one(command + " " + wanted, verb, {arguments.begin() + 1, arguments.end()});
  }
  const std::string near = runtime::nearest_name(wanted, names);
  return say_wrong_call("there is no 'goshawk " + command + " " + wanted + "'" +
                        (near.empty() ? "" : "; did you mean " + near + "?") + "\n" +
                        usage(command, verbs));
}

Interruptible::Interruptible() {
  g_interrupted = false;
  struct sigaction action {};
  action.sa_handler = [](int) { g_interrupted = true; };
  sigemptyset(&action.sa_mask);
  sigaction(SIGINT, &action, &g_old_int);
  sigaction(SIGTERM, &action, &g_old_term);
}

Interruptible::~Interruptible() {
  sigaction(SIGINT, &g_old_int, nullptr);
  sigaction(SIGTERM, &g_old_term, nullptr);
}

bool Interruptible::interrupted() {
  return g_interrupted;
}

Result<std::unique_ptr<Session>> Session::open() {
  auto options = runtime::ContextOptions::from_environment();
  if (!options) return options.error();
  auto session = std::make_unique<Session>();
  auto context = runtime::Context::create(*options);  // names no node: lists leave it out
  if (!context) return context.error();
  session->context_ = *std::move(context);
  session->node_ = std::make_unique<runtime::Node>(*session->context_, "goshawk_cli");
  return session;
}

bool Session::wait_for(double timeout_s, const std::function<bool()>& done) {
  const auto begin = Steady::now();
  while (!done()) {
    const double left_s = timeout_s - seconds_since(begin);
    if (left_s <= 0.0 || Interruptible::interrupted()) return false;
    node_->spin_some(std::min(kSlice_s, left_s));
  }
  return true;
}

void Session::settle(double timeout_s, const std::function<int()>& count) {
  int known = 0;
  auto changed = Steady::now();
  wait_for(timeout_s, [&] {
    const int now = count();
    if (now != known) changed = Steady::now();
    known = now;
    return known > 0 && seconds_since(changed) > kSettled_s;
  });
}

void Session::settle(double timeout_s) {
  settle(timeout_s,
         [&] { return int(context_->participants().size() + context_->endpoints().size()); });
}

std::vector<runtime::EndpointInfo> Session::endpoints_of(const std::string& topic) const {
  std::vector<runtime::EndpointInfo> list;
  for (auto& endpoint : context_->endpoints()) {
    if (endpoint.topic == topic) list.push_back(std::move(endpoint));
  }
  return list;
}

std::string Session::nearest_topic(const std::string& topic) const {
  std::set<std::string> topics;
  for (const auto& endpoint : context_->endpoints()) topics.insert(endpoint.topic);
  return runtime::nearest_name(topic, {topics.begin(), topics.end()});
}

int Session::say_no_reader(const std::string& topic, const std::string& type) const {
  for (const auto& e : endpoints_of(topic)) {
    if (!e.writer && e.type != type) {
      return say_wrong_call(topic + " is read as " + e.type + ", not as " + type);
    }
  }
  const std::string near = nearest_topic(topic);
  const std::string sentence = "nobody reads " + topic + ", nothing was published";
  if (near.empty() || near == topic) return say_nothing(sentence);
  return say_wrong_call(sentence + "; did you mean " + near + "?");
}

int Session::say_no_topic(const std::string& topic, double timeout_s) const {
  const std::string near = nearest_topic(topic);
  char waited[32];
  std::snprintf(waited, sizeof waited, "%g", timeout_s);
  const std::string sentence = "nobody writes or reads " + topic + " in domain " +
                               std::to_string(context_->domain()) + " (waited " + waited + " s)";
  if (context_->endpoints().empty()) {
    return say_nothing(sentence +
                       ": no topic at all was found. Is something running, with the "
                       "same ROS_DOMAIN_ID?");
  }
  if (near.empty()) return say_nothing(sentence + "; goshawk topic list shows what there is");
  return say_wrong_call(sentence + "; did you mean " + near + "?");
}

Result<std::string> full_topic_name(const std::string& topic) {
  const std::string full = topic.starts_with('/') ? topic : "/" + topic;
  if (auto status = runtime::check_topic_name(full); !status) return status.error();
  return full;
}

}  // namespace goshawk::introspection
