#include "goshawk/runtime/ros_args.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <utility>

namespace goshawk::runtime {
namespace {

Result<std::pair<std::string, std::string>> split(const std::string& text, const char* what) {
  const auto at = text.find(":=");
  if (at == std::string::npos || at == 0 || at + 2 == text.size()) {
    return fail(ErrorCode::invalid_input,
                fmt::format("{} '{}' is not of the form name:=value", what, text));
  }
  return std::pair{text.substr(0, at), text.substr(at + 2)};
}

Status add_remap(RosArgs& args, const std::string& text) {
  auto rule = split(text, "remapping");
  if (!rule) return rule.error();
  auto& [from, to] = *rule;
  if (from == "__ns") {
    args.node_namespace = to.starts_with('/') ? to : "/" + to;
    return check_topic_name(args.node_namespace);
  }
  if (from == "__node" || from == "__name") {
    args.node_name = to;
    if (to.find('/') == std::string::npos) return check_topic_name(to);
    return fail(ErrorCode::invalid_input,
                fmt::format("node name '{}' contains a '/': set the namespace with -r __ns:=", to));
  }
  const auto colon = from.find(':');
  RosArgs::Remap remap{from, to};
  if (colon != std::string::npos) {
    remap.node = from.substr(0, colon);
    remap.from = from.substr(colon + 1);
    if (auto status = check_topic_name(remap.node); !status) return status;
  }
  for (const auto& name : {remap.from, remap.to}) {
    if (auto status = check_topic_name(name); !status) return status;
  }
  args.remaps.push_back(std::move(remap));
  return success();
}

Status add_override(RosArgs& args, const std::string& text) {
  auto rule = split(text, "parameter");
  if (!rule) return rule.error();
  auto& [name, value] = *rule;
  const auto colon = name.find(':');
  if (colon == std::string::npos) {
    args.overrides.push_back({"", name, value});
  } else {
    args.overrides.push_back({name.substr(0, colon), name.substr(colon + 1), value});
  }
  return success();
}

Status take_option(RosArgs& args, const std::string& option, const std::string& value) {
  if (option == "-r" || option == "--remap") return add_remap(args, value);
  if (option == "-p" || option == "--param") return add_override(args, value);
  if (option == "--params-file") {
    args.params_files.push_back(value);
    return success();
  }
  if (option == "--log-level") {
    static constexpr const char* kLevels[] = {"trace", "debug", "info", "warn", "error", "off"};
    if (std::ranges::find(kLevels, value) == std::end(kLevels)) {
      return fail(ErrorCode::invalid_input,
                  "log level '" + value + "' is not trace, debug, info, warn, error or off");
    }
    args.log_level = value;
    return success();
  }
  return fail(ErrorCode::invalid_input,
              fmt::format("--ros-args has no option '{}': use -r, -p, --params-file or --log-level",
                          option));
}

}  // namespace

Result<RosArgs> RosArgs::extract(std::vector<std::string>& arguments) {
  RosArgs args;
  // ROS allows several such parts; each ends at "--".
  for (;;) {
    const auto begin = std::ranges::find(arguments, "--ros-args");
    if (begin == arguments.end()) return args;
    auto it = begin + 1;
    for (; it != arguments.end() && *it != "--" && *it != "--ros-args"; ++it) {
      const std::string option = *it;
      if (++it == arguments.end()) {
        return fail(ErrorCode::invalid_input, fmt::format("'{}' needs a value", option));
      }
      if (auto status = take_option(args, option, *it); !status) return status.error();
    }
    if (it != arguments.end() && *it == "--") ++it;
    arguments.erase(begin, it);
  }
}

Result<ParameterSource> RosArgs::parameters_of(std::string_view name) const {
  ParameterSource source;
  for (const auto& file : params_files) {
    if (auto status = source.add_file(file, name, node_namespace); !status) return status.error();
  }
  for (const auto& o : overrides) {
    if (!o.node.empty() && o.node != name) continue;
    source.set(o.name, ParameterSource::written(o.value, "-p"));
  }
  return source;
}

std::string RosArgs::resolve_topic(std::string_view topic, std::string_view node) const {
  const auto absolute = [&](std::string_view name) {
    if (name.starts_with('/')) return std::string(name);
    return (node_namespace == "/" ? "" : node_namespace) + "/" + std::string(name);
  };
  for (const auto& rule : remaps) {
    if (!rule.node.empty() && rule.node != node) continue;
    if (rule.from == topic || absolute(rule.from) == absolute(topic)) return absolute(rule.to);
  }
  return absolute(topic);
}

Status check_topic_name(std::string_view topic) {
  const bool allowed = !topic.empty() && std::ranges::all_of(topic, [](unsigned char c) {
    return std::isalnum(c) != 0 || c == '_' || c == '/';
  });
  if (allowed && topic.find("//") == std::string_view::npos &&
      (topic == "/" || !topic.ends_with('/'))) {
    return success();
  }
  return fail(ErrorCode::invalid_input,
              fmt::format("'{}' is not a valid name: use letters, digits and '_', with single '/' "
                          "between parts",
                          topic));
}

}  // namespace goshawk::runtime
