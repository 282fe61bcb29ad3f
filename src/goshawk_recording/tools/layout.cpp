#include "goshawk/recording_tools/layout.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <optional>
#include <sstream>
#include <vector>

#include "goshawk/runtime/schema.hpp"

namespace goshawk::recording {
namespace {

namespace schema = runtime::schema;

constexpr int kDeepest = 32;  // no message is nested deeper; ends definitions that hold themselves
// In the order of schema::Kind.
constexpr std::string_view kPrimitives[] = {"bool",   "int8",    "uint8",   "int16",
                                            "uint16", "int32",   "uint32",  "int64",
                                            "uint64", "float32", "float64", "string"};

std::string group(std::string_view count, const std::string& inner) {
  return fmt::format("[{} {}]", count, inner);
}

void append(std::string& layout, const std::string& part) {
  layout += (layout.empty() ? "" : " ") + part;
}

// ---- from .msg text

struct MsgField {
  std::string type;   // "float64", "std_msgs/Header"
  std::string count;  // of an array; "*": a sequence; empty: single
};
using Definitions = std::map<std::string, std::vector<MsgField>>;  // the root has the empty name

// "geometry_msgs/Point[6] control_points" @return nothing for a constant or an empty line
std::optional<MsgField> field_in(std::string line) {
  line = line.substr(0, line.find('#'));
  if (line.find('=') != std::string::npos) return {};
  std::istringstream words(line);
  MsgField field;
  std::string name;
  if (!(words >> field.type >> name)) return {};
  const auto bracket = field.type.find('[');
  if (bracket == std::string::npos) return field;
  field.count = field.type.substr(bracket + 1, field.type.size() - bracket - 2);
  if (field.count.empty()) field.count = "*";
  field.type.resize(bracket);
  return field;
}

Definitions definitions_in(std::string_view text) {
  Definitions definitions;
  std::istringstream in{std::string(text)};
  std::string name;
  definitions[name];
  for (std::string line; std::getline(in, line);) {
    if (line.starts_with("MSG: ")) {
      name = line.substr(5);
      definitions[name];
    } else if (auto field = field_in(line)) {
      definitions[name].push_back(*std::move(field));
    }
  }
  return definitions;
}

// @return nothing if a type is missing
std::optional<std::string> layout_of(const Definitions& definitions, const std::string& name,
                                     int depth) {
  const auto found = definitions.find(name);
  if (found == definitions.end() || depth > kDeepest) return {};
  std::string layout;
  for (const MsgField& field : found->second) {
    std::optional<std::string> inner = field.type;
    if (std::ranges::find(kPrimitives, field.type) == std::end(kPrimitives)) {
      inner = layout_of(definitions, field.type, depth + 1);
      if (!inner) return {};
    }
    append(layout, field.count.empty() ? *inner : group(field.count, *inner));
  }
  return layout;
}

// ---- from our own types

std::string layout_of(const schema::Type& type) {
  std::string layout;
  for (const auto& field : type.fields) {
    const std::string inner = field.kind == schema::Kind::structure
                                  ? layout_of(schema::types()[std::size_t(field.type)])
                                  : std::string(kPrimitives[std::size_t(field.kind)]);
    switch (field.arity) {
      case schema::Arity::single:
        append(layout, inner);
        break;
      case schema::Arity::array:
        append(layout, group(std::to_string(field.size), inner));
        break;
      case schema::Arity::sequence:
        append(layout, group("*", inner));
        break;
    }
  }
  return layout;
}

bool is_foreign(const Reader& reader, const Channel& channel) {
  const Schema* recorded = reader.schema_of(channel);
  if (recorded == nullptr || recorded->encoding != "ros2msg") return false;  // nothing to compare
  const std::string ours = layout_of_type(recorded->name);
  if (ours.empty()) return recorded->name.starts_with("goshawk_msgs/");
  return layout_of_definition(recorded->data) != ours;
}

}  // namespace

std::string layout_of_definition(std::string_view definition) {
  return layout_of(definitions_in(definition), "", 0).value_or("");
}

std::string layout_of_type(std::string_view type_name) {
  const auto all = schema::types();
  const auto type = std::ranges::find(all, type_name, &schema::Type::name);
  return type == all.end() ? "" : layout_of(*type);
}

Status check_layout(const Reader& reader, const std::set<std::uint16_t>& channels) {
  std::string foreign;
  for (const auto& [id, channel] : reader.channels()) {
    if (!channels.contains(id) || !is_foreign(reader, channel)) continue;
    foreign += fmt::format("{}{} ({})", foreign.empty() ? "" : ", ", channel.topic,
                           reader.schema_of(channel)->name);
  }
  if (foreign.empty()) return success();
  return fail(ErrorCode::invalid_input,
              fmt::format("recorded by another version of Goshawk, with other messages on {}: use "
                          "the version that recorded it, record the flight again, or choose other "
                          "topics",
                          foreign));
}

}  // namespace goshawk::recording
