#include "goshawk/league/settings.hpp"

#include <fmt/format.h>
#include <yaml-cpp/yaml.h>

#include <charconv>

namespace goshawk::league {
namespace {

/// Gives the parameter of this name its value.
struct Setter {
  const std::string& name;
  const std::string& text;
  bool found = false;
  bool fits = true;

  template <typename Value, typename Allowed>
  void operator()(const char* its_name, Value& value, const char*, const char*, const Allowed&) {
    if (name != its_name) return;
    found = true;
    fits = read(value);
  }

  template <typename Number>
  bool read(Number& value) const {
    const char* end = text.data() + text.size();
    const auto [at, code] = std::from_chars(text.data(), end, value);
    return code == std::errc() && at == end;
  }
  bool read(bool& value) const {
    value = text == "true";
    return text == "true" || text == "false";
  }
  bool read(std::string& value) const {
    value = text;
    return true;
  }
  template <Worded E>
  bool read(E& value) const {
    const auto word = from_word<E>(text);
    if (word) value = *word;
    return bool(word);
  }
};

template <typename Config>
Status set(Config& config, const std::string& setting, const std::string& name,
           const std::string& value) {
  Setter setter{name, value};
  describe(config, setter);
  if (setter.found && setter.fits) return success();
  return fail(ErrorCode::invalid_parameter,
              fmt::format("'{}': {}", setting,
                          setter.found ? "the value is not of its type"
                                       : "the node has no such parameter (docs/parameters.md)"));
}

}  // namespace

Status apply_setting(const std::string& setting, closed_loop::Setup& setup) {
  const auto colon = setting.find(':'), equals = setting.find('=');
  if (colon == std::string::npos || equals == std::string::npos || equals < colon) {
    return fail(ErrorCode::invalid_parameter,
                fmt::format("'{}' is not NODE:PARAMETER=VALUE", setting));
  }
  const std::string node = setting.substr(0, colon), value = setting.substr(equals + 1);
  const std::string name = setting.substr(colon + 1, equals - colon - 1);
  if (node == "navigator") return set(setup.navigator, setting, name, value);
  if (node == "tracker") return set(setup.tracker, setting, name, value);
  if (node == "simulator") return set(setup.vehicle, setting, name, value);
  if (node == "path_search") return set(setup.planning.search, setting, name, value);
  if (node == "corridor_builder") return set(setup.planning.corridor, setting, name, value);
  if (node == "trajectory_optimizer") return set(setup.planning.optimizer, setting, name, value);
  return fail(ErrorCode::invalid_parameter, fmt::format("no node is called '{}'", node));
}

Status apply_file(const std::filesystem::path& file, closed_loop::Setup& setup) {
  try {
    for (const auto& node : YAML::LoadFile(file.string())) {
      const std::string name = node.first.as<std::string>();
      for (const auto& parameter : node.second["ros__parameters"]) {
        const auto setting = fmt::format("{}:{}={}", name, parameter.first.as<std::string>(),
                                         parameter.second.as<std::string>());
        if (auto status = apply_setting(setting, setup); !status) {
          return fail(status.code(), fmt::format("{}: {}", file.string(), status.error().message));
        }
      }
    }
  } catch (const YAML::BadFile&) {
    return fail(ErrorCode::io_failed, fmt::format("cannot read {}", file.string()));
  } catch (const YAML::Exception& e) {
    return fail(ErrorCode::invalid_parameter,
                fmt::format("{} is no parameter file: {}", file.string(), e.what()));
  }
  return success();
}

}  // namespace goshawk::league
