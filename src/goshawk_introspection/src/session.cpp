#include "goshawk/introspection/session.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <set>

#include "goshawk/introspection/services.hpp"
#include "goshawk/runtime/parameters.hpp"

namespace goshawk::introspection {
namespace {

using Steady = std::chrono::steady_clock;

constexpr double kSlice_s = 0.02;  // how often a wait looks for Ctrl-C
// Participants that miss each other's first announcements meet at the next one, half a second
// later (runtime's Context); their endpoints follow within milliseconds.
constexpr double kSettled_s = 0.7;

double seconds_since(Steady::time_point begin) {
  return std::chrono::duration<double>(Steady::now() - begin).count();
}

}  // namespace

Result<std::unique_ptr<Session>> Session::open() {
  auto options = runtime::ContextOptions::from_environment();
  if (!options) return options.error();
  auto session = std::make_unique<Session>();
  auto context = runtime::Context::create(*options);  // names no node: lists leave it out
  if (!context) return context.error();
  session->context_ = *std::move(context);
  if (auto status = session->context_->watch_ros_nodes(); !status) return status.error();
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
  settle(timeout_s, [&] {
    return int(context_->participants().size() + context_->endpoints().size() + nodes().size());
  });
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
  for (const auto& endpoint : context_->endpoints()) {
    if (!service_end(endpoint)) topics.insert(endpoint.topic);
  }
  return runtime::nearest_name(topic, {topics.begin(), topics.end()});
}

std::vector<std::string> Session::nodes() const {
  std::vector<std::string> names;
  for (const auto& p : context_->participants()) {
    names.insert(names.end(), p.nodes.begin(), p.nodes.end());
  }
  return names;
}

Error Session::no_node(const std::string& node) const {
  const auto known = nodes();
  const std::string near = runtime::nearest_name(node, known);
  return fail(ErrorCode::stage_silent,
              fmt::format("there is no node {} in domain {}{}", node, context_->domain(),
                          known.empty()  ? ", nor any other. Is something running, with the same "
                                           "ROS_DOMAIN_ID?"
                          : near.empty() ? "; goshawk node list shows what there is"
                                         : fmt::format("; did you mean {}?", near)));
}

Error Session::no_reader(const std::string& topic, const std::string& type) const {
  for (const auto& e : endpoints_of(topic)) {
    if (!e.writer && e.type != type) {
      return fail(ErrorCode::invalid_parameter,
                  fmt::format("{} is read as {}, not as {}", topic, e.type, type));
    }
  }
  const std::string near = nearest_topic(topic);
  const std::string sentence = fmt::format("nobody reads {}, nothing was published", topic);
  if (near.empty() || near == topic) return fail(ErrorCode::stage_silent, sentence);
  return fail(ErrorCode::invalid_parameter, fmt::format("{}; did you mean {}?", sentence, near));
}

Error Session::no_topic(const std::string& topic, double timeout_s) const {
  const std::string sentence = fmt::format("nobody writes or reads {} in domain {} (waited {:g} s)",
                                           topic, context_->domain(), timeout_s);
  if (context_->endpoints().empty()) {
    return fail(ErrorCode::stage_silent,
                sentence +
                    ": no topic at all was found. Is something running, with the same "
                    "ROS_DOMAIN_ID?");
  }
  const std::string near = nearest_topic(topic);
  if (near.empty()) {
    return fail(ErrorCode::stage_silent, sentence + "; goshawk topic list shows what there is");
  }
  return fail(ErrorCode::invalid_parameter, fmt::format("{}; did you mean {}?", sentence, near));
}

Result<std::string> full_topic_name(const std::string& topic) {
  const std::string full = topic.starts_with('/') ? topic : "/" + topic;
  if (auto status = runtime::check_topic_name(full); !status) {
    return fail(ErrorCode::invalid_parameter, status.error().message);
  }
  return full;
}

Result<std::string> full_topic_pattern(const std::string& pattern) {
  if (!pattern.ends_with('*')) return full_topic_name(pattern);
  const std::string full = pattern.starts_with('/') ? pattern : "/" + pattern;
  const std::string name = full.substr(0, full.find_last_not_of("*/") + 1);
  if (name.empty()) return full;
  if (auto checked = full_topic_name(name); !checked) return checked.error();
  return full;
}

bool matches(const std::vector<std::string>& patterns, const std::string& topic) {
  return std::ranges::any_of(patterns, [&](const std::string& pattern) {
    if (!pattern.ends_with('*')) return pattern == topic;
    return topic.starts_with(pattern.substr(0, pattern.size() - 1));
  });
}

}  // namespace goshawk::introspection
