#include "goshawk/introspection/schema.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <vector>

#include "goshawk/runtime/parameters.hpp"

namespace goshawk::introspection {

namespace {

// In the order of Kind.
constexpr std::array<std::string_view, 13> kRosNames = {
    "bool",  "int8",   "uint8",   "int16",   "uint16", "int32", "uint32",
    "int64", "uint64", "float32", "float64", "string", ""};

// "goshawk_msgs/msg/Path" to "goshawk_msgs/Path", as .msg files refer to types.
std::string short_name(std::string_view name) {
  return std::string(name.substr(0, name.find('/'))) + std::string(name.substr(name.rfind('/')));
}

void add_fields(const Type& type, std::string& text, std::vector<int>& inner) {
  for (const auto& field : type.fields) {
    // Right before their field: viewers then show the name beside the number.
    for (const auto& constant : field.constants) {
      text += fmt::format("{} {}={}\n", ros_name(field.kind), constant.name, constant.value);
    }
    if (field.kind == Kind::structure) {
      text += short_name(all_types()[std::size_t(field.type)].name);
      if (std::ranges::find(inner, field.type) == inner.end()) inner.push_back(field.type);
    } else {
      text += ros_name(field.kind);
    }
    if (field.arity == Arity::array) text += fmt::format("[{}]", field.size);
    if (field.arity == Arity::sequence) text += "[]";
    text += " " + std::string(field.name);
    if (!field.comment.empty()) text += "  # " + std::string(field.comment);
    text += "\n";
  }
}

}  // namespace

std::string_view ros_name(Kind kind) {
  return kRosNames[std::size_t(kind)];
}

Result<const Type*> find_type(std::string_view name) {
  std::vector<std::string> names;
  for (const auto& type : all_types()) {
    if (type.name == name || short_name(type.name) == name) return &type;
    names.emplace_back(type.name);
  }
  const std::string near = runtime::nearest_name(name, names);
  return fail(ErrorCode::invalid_input,
              fmt::format("'{}' is not a message type that Goshawk knows; {}", name,
                          near.empty() ? "types have names like goshawk_msgs/msg/Path"
                                       : "did you mean " + near + "?"));
}

std::string ros_msg_definition(const Type& type) {
  std::string text = type.comment.empty() ? "" : "# " + std::string(type.comment) + "\n";
  std::vector<int> inner;
  add_fields(type, text, inner);
  for (std::size_t i = 0; i < inner.size(); ++i) {  // grows while inner types are added
    const Type& t = all_types()[std::size_t(inner[i])];
    text += std::string(80, '=') + "\nMSG: " + short_name(t.name) + "\n";
    add_fields(t, text, inner);
  }
  return text;
}

Result<std::string> ros_msg_definition(std::string_view type_name) {
  auto type = find_type(type_name);
  if (!type) return type.error();
  return ros_msg_definition(**type);
}

}  // namespace goshawk::introspection
