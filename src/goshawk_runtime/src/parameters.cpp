#include "goshawk/runtime/parameters.hpp"

#include <fmt/format.h>
#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <numeric>
#include <set>

namespace goshawk::runtime {
namespace {

std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t above = row[j];
      row[j] = std::min({row[j] + 1, row[j - 1] + 1, diagonal + (a[i - 1] != b[j - 1])});
      diagonal = above;
    }
  }
  return row.back();
}

std::string did_you_mean(const std::string& near) {
  return near.empty() ? "" : fmt::format("; did you mean {}?", near);
}

// yaml-cpp marks quoted scalars with the tag "!".
Status add_section(const YAML::Node& section, const std::string& where, ParameterSource& source) {
  const YAML::Node parameters = section.IsMap() ? section["ros__parameters"] : YAML::Node();
  if (!parameters || !(parameters.IsMap() || parameters.IsNull())) {
    return fail(ErrorCode::invalid_parameter,
                where +
                    " has no map ros__parameters: write\n  NODE:\n    ros__parameters:\n"
                    "      NAME: VALUE");
  }
  std::set<std::string> seen;
  for (const auto& pair : parameters) {
    const std::string name = pair.first.as<std::string>();
    ParameterSource::Entry entry{"", where, pair.second.Tag() == "!", ""};
    if (pair.second.IsScalar()) {
      entry.text = pair.second.Scalar();
    } else {
      entry.fault = "is not a single value: empty entries, lists and maps are not allowed here";
    }
    if (!seen.insert(name).second) entry.fault = "is specified twice: remove one of them";
    source.set(name, std::move(entry));
  }
  return success();
}

}  // namespace

Status ParameterSource::add_file(const std::string& path, std::string_view node_name,
                                 std::string_view node_namespace) {
  std::string full(node_namespace);
  if (!full.ends_with('/')) full += '/';
  full += node_name;
  if (std::error_code ignored; std::filesystem::is_directory(path, ignored)) {
    return fail(ErrorCode::io_failed, path + " is a folder, not a file of parameters");
  }
  try {
    const YAML::Node file = YAML::LoadFile(path);
    if (file.IsNull()) return success();
    if (!file.IsMap()) {
      return fail(ErrorCode::invalid_parameter, path + " is not a map of node names");
    }
    for (const std::string& key : {std::string("/**"), std::string(node_name), full}) {
      if (!file[key]) continue;
      if (auto status = add_section(file[key], path + ", " + key, *this); !status) return status;
    }
  } catch (const YAML::BadFile&) {
    return fail(ErrorCode::io_failed, path + " cannot be read: does it exist?");
  } catch (const YAML::Exception& e) {
    return fail(ErrorCode::invalid_parameter, path + " is not valid YAML: " + e.what());
  }
  return success();
}

// name:="'5'" is the string 5, as in a YAML file.
ParameterSource::Entry ParameterSource::written(const std::string& value,
                                                const std::string& origin) {
  const bool quoted = value.size() >= 2 && (value.front() == '"' || value.front() == '\'') &&
                      value.back() == value.front();
  return {quoted ? value.substr(1, value.size() - 2) : value, origin, quoted, ""};
}

Status check_sections(const std::string& params_file, const std::vector<std::string>& known) {
  std::string faults;
  try {
    const YAML::Node file = YAML::LoadFile(params_file);
    if (!file.IsNull() && !file.IsMap()) {
      return fail(ErrorCode::invalid_parameter, params_file + " is not a map of node names");
    }
    for (const auto& section : file) {
      const std::string name = section.first.as<std::string>();
      const std::string node = name.substr(name.rfind('/') + 1);
      if (name == "/**" || std::ranges::find(known, node) != known.end()) continue;
      const std::string near = nearest_name(node, known);
      faults += fmt::format("\n  {}: no such node{}", name, did_you_mean(near));
    }
  } catch (const YAML::BadFile&) {
    return fail(ErrorCode::io_failed, params_file + " cannot be read: does it exist?");
  } catch (const YAML::Exception& e) {
    return fail(ErrorCode::invalid_parameter, params_file + " is not valid YAML: " + e.what());
  }
  if (faults.empty()) return success();
  return fail(ErrorCode::invalid_parameter,
              params_file + " has sections for nodes that do not exist:" + faults);
}

std::string nearest_name(std::string_view wrong, const std::vector<std::string>& known) {
  std::string best;
  std::size_t least = std::max<std::size_t>(3, wrong.size() / 2 + 1);
  for (const auto& name : known) {
    // A name without its unit, as v_max for v_max_m_s, is the nearest of all.
    const bool begins = wrong.size() >= 3 && name.starts_with(wrong) && name[wrong.size()] == '_';
    const std::size_t distance = begins ? 1 : edit_distance(wrong, name);
    if (distance < least) {
      least = distance;
      best = name;
    }
  }
  return best;
}

namespace detail {

std::string parse(const ParameterSource::Entry& entry, bool& value) {
  if (!entry.quoted && (entry.text == "true" || entry.text == "false")) {
    value = entry.text == "true";
    return "";
  }
  return "is not true or false";
}

template <typename Number>
std::string parse_number(const ParameterSource::Entry& entry, Number& value, const char* what) {
  const char* first = entry.text.data();
  const char* last = first + entry.text.size();
  // from_chars takes no plus sign: "+5" is a number, "+-5" is not.
  if (last - first > 1 && *first == '+' && first[1] != '-') ++first;
  const auto [end, error] = std::from_chars(first, last, value);
  if (entry.quoted || error != std::errc{} || end != last) return std::string("is not ") + what;
  return "";
}

std::string parse(const ParameterSource::Entry& entry, int& value) {
  return parse_number(entry, value, "a whole number");
}

std::string parse(const ParameterSource::Entry& entry, double& value) {
  return parse_number(entry, value, "a number");
}

std::string parse(const ParameterSource::Entry& entry, std::string& value) {
  value = entry.text;
  return "";
}

std::string range_fault(double value, const Range& range) {
  if (range.contains(value) && std::isfinite(value)) return "";
  return "is out of range: it must be " + range_text(range);
}

std::string range_fault(const std::string& value, const OneOf& one_of) {
  if (std::ranges::find(one_of.choices, value) != one_of.choices.end()) return "";
  return not_a_choice(value, one_of.choices);
}

std::string not_a_choice(const std::string& word, const std::vector<std::string>& choices) {
  const std::string near = nearest_name(word, choices);
  return "is not a choice: it must be " + range_text(OneOf{choices}) + did_you_mean(near);
}

std::string to_text(bool value) {
  return value ? "true" : "false";
}
std::string to_text(int value) {
  return std::to_string(value);
}
std::string to_text(double value) {
  return fmt::format("{}", value);
}
std::string to_text(const std::string& value) {
  return value;
}

std::string range_text(const Range& range) {
  const bool upper = range.hi < 1e300;
  if (range.lo == -std::numeric_limits<double>::infinity()) {
    return upper ? "at most " + to_text(range.hi) : "finite";
  }
  std::string text = (range.above_lo ? "above " : "at least ") + to_text(range.lo);
  if (upper) text += " and at most " + to_text(range.hi);
  return text;
}

std::string range_text(const OneOf& one_of) {
  std::string text;
  for (const auto& choice : one_of.choices) text += (text.empty() ? "" : ", ") + choice;
  return "one of " + text;
}

void Reader::add_fault(const std::string& name, const ParameterSource::Entry& entry,
                       const std::string& fault) {
  faults_.push_back(fmt::format("{}: '{}' {} ({})", name, entry.text, fault, entry.origin));
}

std::string Reader::change_fault(const std::string& name, const ParameterSource::Entry& entry,
                                 bool at_run_time) const {
  if (changeable_ == Changeable::at_start) return "";
  if (changeable_ == Changeable::at_run_time && at_run_time) return "";
  return "takes effect at start only: restart the node with -p " + name + ":=" + entry.text;
}

Status Reader::finish(std::string_view node_name) {
  for (const auto& [name, entry] : source_.entries()) {
    if (std::ranges::find(known_, name) != known_.end()) continue;
    const std::string near = nearest_name(name, known_);
    faults_.push_back(fmt::format("{}: no such parameter of {}{} ({})", name, node_name,
                                  did_you_mean(near), entry.origin));
  }
  if (faults_.empty()) return success();
  std::string text = fmt::format("{} has {} parameter fault{}:", node_name, faults_.size(),
                                 faults_.size() == 1 ? "" : "s");
  for (const auto& fault : faults_) text += "\n  " + fault;
  return fail(ErrorCode::invalid_parameter, text);
}

}  // namespace detail
}  // namespace goshawk::runtime
