#pragma once

#include <array>
#include <cmath>
#include <map>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "goshawk/core/parameter.hpp"
#include "goshawk/core/result.hpp"
#include "goshawk/core/words.hpp"

namespace goshawk::runtime {

/// What the user set for one node: names to YAML scalars, in the order of precedence already
/// resolved (files first to last, then `-p`).
class ParameterSource {
 public:
  struct Entry {
    std::string text;     // as written
    std::string origin;   // file or option that set it, for the sentence of a fault
    bool quoted = false;  // a quoted YAML scalar is a string, even when it looks like a number
    std::string fault;    // why it cannot be a value; empty: it can
  };

  /// Adds the sections of a ROS style file that apply to this node: `/**`, the node's name
  /// and its full name (`/uav1/path_search`), each with a map `ros__parameters`.
  /// @return io_failed if the file cannot be read, invalid_parameter if its form is wrong
  Status add_file(const std::string& path, std::string_view node_name,
                  std::string_view node_namespace);

  /// One value as a user writes it after `name:=`; in quotes it is always a string.
  static Entry written(const std::string& value, const std::string& origin);

  void set(const std::string& name, Entry entry) { entries_[name] = std::move(entry); }
  const std::map<std::string, Entry>& entries() const { return entries_; }

 private:
  std::map<std::string, Entry> entries_;
};

/// A section for an unknown node is a typing error whose parameters would be ignored silently.
/// @param known names of nodes, without namespace
/// @return invalid_parameter that names each such section and the nearest name; io_failed
Status check_sections(const std::string& params_file, const std::vector<std::string>& known);

/// One parameter as documented: for `goshawk param describe` and docs/parameters.md.
struct ParameterDescription {
  std::string name;
  std::string type;  // "bool", "int", "double", "string"
  std::string unit;  // empty: none
  std::string text;
  std::string default_value;
  std::string range;         // in words; empty: any value
  std::string value;         // of the struct that was described
  bool at_run_time = false;  // may change while the node runs
};

/// @return the name among `known` that a user most likely meant, or empty
std::string nearest_name(std::string_view wrong, const std::vector<std::string>& known);

namespace detail {

/// Reads one value. @return what is wrong with it (empty: nothing)
std::string parse(const ParameterSource::Entry& entry, bool& value);
std::string parse(const ParameterSource::Entry& entry, int& value);
std::string parse(const ParameterSource::Entry& entry, double& value);
std::string parse(const ParameterSource::Entry& entry, std::string& value);
std::string not_a_choice(const std::string& word, const std::vector<std::string>& choices);
template <Worded E>
std::string parse(const ParameterSource::Entry& entry, E& value) {
  const auto parsed = from_word<E>(entry.text);
  if (!parsed) return not_a_choice(entry.text, all_words<E>());
  value = *parsed;
  return "";
}

std::string range_fault(double value, const Range& range);
inline std::string range_fault(double value, const Anything&) {
  return std::isfinite(value) ? "" : "is not finite";
}
std::string range_fault(const std::string& value, const OneOf& one_of);
inline std::string range_fault(const std::string&, const Anything&) {
  return "";
}
template <Worded E>
std::string range_fault(E, const Anything&) {
  return "";
}

std::string to_text(bool value);
std::string to_text(int value);
std::string to_text(double value);
std::string to_text(const std::string& value);
template <Worded E>
std::string to_text(E value) {
  return std::string(to_word(value));
}

/// What a value may be, in words; empty if anything goes.
std::string range_text(const Range& range);
std::string range_text(const OneOf& one_of);
template <typename T, typename Allowed>
std::string range_of(const Allowed& allowed) {
  if constexpr (!std::is_base_of_v<Anything, Allowed>)
    return range_text(allowed);
  else if constexpr (Worded<T>)
    return range_text(OneOf{all_words<T>()});
  else
    return "";
}

/// Which parameters may be given: all at start, those AtRunTime later, or none any more.
enum class Changeable { at_start, at_run_time, no };

/// Collects all faults of a node's parameters, to report them together.
class Reader {
 public:
  explicit Reader(const ParameterSource& source, Changeable changeable = Changeable::at_start)
      : source_(source), changeable_(changeable) {}

  template <typename T, typename Allowed>
  void operator()(const char* name, T& value, const char*, const char*, const Allowed& allowed) {
    known_.emplace_back(name);
    const auto entry = source_.entries().find(name);
    if (entry == source_.entries().end()) return;
    T parsed = value;
    std::string fault = entry->second.fault;
    if (fault.empty()) fault = change_fault(name, entry->second, is_at_run_time<Allowed>);
    if (fault.empty()) fault = parse(entry->second, parsed);
    if (fault.empty()) fault = range_fault(parsed, allowed);
    if (fault.empty()) {
      value = parsed;
    } else {
      add_fault(name, entry->second, fault);
    }
  }

  /// Adds the unknown names. @return all faults in one sentence each, or success
  Status finish(std::string_view node_name);

 private:
  void add_fault(const std::string& name, const ParameterSource::Entry& entry,
                 const std::string& fault);
  std::string change_fault(const std::string& name, const ParameterSource::Entry& entry,
                           bool at_run_time) const;

  const ParameterSource& source_;
  Changeable changeable_;
  std::vector<std::string> known_;
  std::vector<std::string> faults_;
};

template <typename T>
constexpr const char* type_name() {
  if constexpr (std::is_same_v<T, bool>)
    return "bool";
  else if constexpr (std::is_same_v<T, int>)
    return "int";
  else if constexpr (std::is_same_v<T, double>)
    return "double";
  else
    return "string";
}

}  // namespace detail

/// Who may set the parameters of a running node (docs/security.md).
enum class ParameterSetters { user, any, none };
constexpr auto words_of(ParameterSetters) {
  return std::to_array<Named<ParameterSetters>>({
      {ParameterSetters::user, "user"},  // processes of this user, or of root, on this machine
      {ParameterSetters::any, "any"},
      {ParameterSetters::none, "none"},
  });
}

/// Parameters that every node has besides its own.
struct NodeParameters {
  bool use_sim_time = false;  // now and timers follow /clock, as in ROS
  bool lock_step = false;     // the node runs in turns: its plant names it in lock_step_nodes
  ParameterSetters set_parameters = ParameterSetters::user;
};

/// Fills a config struct, strictly: an unknown name, a wrong type or a value out of range is a
/// fault, and the error (invalid_parameter) lists all of them, one a line.
/// @param common takes the parameters that every node has; may be null
/// @param config values of the parameters that the source does not set
template <typename Config>
Result<Config> read_parameters(const ParameterSource& source, std::string_view node_name,
                               NodeParameters* common = nullptr, Config config = {},
                               detail::Changeable changeable = detail::Changeable::at_start) {
  detail::Reader reader(source, changeable);
  describe(config, reader);
  NodeParameters ignored;
  NodeParameters& c = common != nullptr ? *common : ignored;
  reader("use_sim_time", c.use_sim_time, "", "", Anything{});
  reader("lock_step", c.lock_step, "", "", Anything{});
  reader("set_parameters", c.set_parameters, "", "", Anything{});
  if (auto status = reader.finish(node_name); !status) return status.error();
  return config;
}

/// @param config its values are listed beside the defaults
template <typename Config>
std::vector<ParameterDescription> describe_parameters(const Config& config) {
  std::vector<ParameterDescription> list;
  const Config defaults;
  describe(defaults, [&](const char* name, const auto& value, const char* unit, const char* text,
                         const auto& allowed) {
    using T = std::remove_cvref_t<decltype(value)>;
    using Allowed = std::remove_cvref_t<decltype(allowed)>;
    list.push_back({name, detail::type_name<T>(), unit, text, detail::to_text(value),
                    detail::range_of<T>(allowed), "", is_at_run_time<Allowed>});
  });
  std::size_t i = 0;
  describe(config, [&](const char*, const auto& value, const char*, const char*, const auto&) {
    list[i++].value = detail::to_text(value);
  });
  return list;
}

template <typename Config>
std::vector<ParameterDescription> describe_parameters() {
  return describe_parameters(Config{});
}

}  // namespace goshawk::runtime
