#include "goshawk/introspection/text.hpp"

#include <fmt/format.h>
#include <yaml-cpp/yaml.h>

#include <charconv>
#include <cmath>

namespace goshawk::introspection {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t kShortArray = 8;  // elements that --no-arr still shows: a pose, a colour
constexpr int kDeepest = 64;            // no message is nested deeper; stops YAML aliases

template <typename T>
bool is_number(const std::string& text, T& value) {
  const char* last = text.data() + text.size();
  const auto [end, error] = std::from_chars(text.data(), last, value);
  return error == std::errc{} && end == last;
}

// YAML's plain scalars have the type that they look like; quoted ones (tag "!") are strings.
Json scalar(const YAML::Node& node) {
  const std::string& text = node.Scalar();
  if (node.Tag() == "!") return text;
  if (text == "true" || text == "false") return text == "true";
  if (text == ".nan" || text == ".inf" || text == "-.inf") {
    return text == "-.inf" ? "-inf" : text.substr(1);
  }
  std::uint64_t whole = 0;
  std::int64_t negative = 0;
  double number = 0.0;
  if (is_number(text, whole)) return whole;
  if (is_number(text, negative)) return negative;
  if (is_number(text, number) && std::isfinite(number)) return number;
  return text;
}

Json from_yaml(const YAML::Node& node, int depth) {
  if (depth > kDeepest) throw YAML::Exception(node.Mark(), "nested too deeply");
  if (node.IsScalar()) return scalar(node);
  if (node.IsSequence()) {
    Json list = Json::array();
    for (const auto& element : node) list.push_back(from_yaml(element, depth + 1));
    return list;
  }
  if (node.IsMap()) {
    Json object = Json::object();
    for (const auto& pair : node) {
      object[pair.first.as<std::string>()] = from_yaml(pair.second, depth + 1);
    }
    return object;
  }
  return nullptr;
}

bool in_one_line(const Json& json) {
  if (!json.is_structured() || json.empty()) return true;
  if (!json.is_array()) return false;
  for (const auto& element : json) {
    if (element.is_structured()) return false;
  }
  return true;
}

// "  # STATE_ARRIVED" behind the value of a constant, else nothing.
std::string comment_of(const Field& field, const Json& value) {
  for (const auto& constant : field.constants) {
    if (value == constant.value) return fmt::format("  # {}", constant.name);
  }
  return {};
}

void write(const Type& type, const Json& message, std::size_t indent, std::string& out);

// A list of messages: a dash stands before each one's first field.
void write_list(const Type& type, const Json& list, std::size_t indent, std::string& out) {
  for (const auto& element : list) {
    std::string inner;
    write(type, element, indent + 2, inner);
    inner.replace(indent, 2, "- ");
    out += inner;
  }
}

void write(const Type& type, const Json& message, std::size_t indent, std::string& out) {
  for (const auto& field : type.fields) {
    const Json& value = message.at(std::string(field.name));
    out += std::string(indent, ' ') + std::string(field.name) + ":";
    if (in_one_line(value)) {
      out += " " + to_line(value) + comment_of(field, value) + "\n";
      continue;
    }
    out += "\n";
    const Type& inner = all_types()[std::size_t(field.type)];
    value.is_array() ? write_list(inner, value, indent + 2, out)
                     : write(inner, value, indent + 2, out);
  }
}

}  // namespace

Result<Json> parse_json_or_yaml(const std::string& text) {
  Json json = Json::parse(text, nullptr, false);
  if (!json.is_discarded()) return json;
  try {
    return from_yaml(YAML::Load(text), 0);
  } catch (const YAML::Exception& e) {
    return fail(ErrorCode::invalid_input,
                fmt::format("'{}' is neither JSON nor YAML: {}", text, e.what()));
  }
}

std::string to_line(const Json& json) {
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

std::string to_yaml(const Type& type, const Json& json) {
  std::string out;
  write(type, json, 0, out);
  return out;
}

void shorten_arrays(Json& json) {
  if (json.is_array() && json.size() > kShortArray) {
    json = fmt::format("<{} elements>", json.size());
  } else if (json.is_structured()) {
    for (auto& element : json) shorten_arrays(element);
  }
}

}  // namespace goshawk::introspection
