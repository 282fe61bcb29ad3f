#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "goshawk/core/result.hpp"

namespace goshawk::introspection {

enum class Kind : std::uint8_t {
  boolean,
  int8,
  uint8,
  int16,
  uint16,
  int32,
  uint32,
  int64,
  uint64,
  float32,
  float64,
  string,
  structure
};

enum class Arity : std::uint8_t { single, array, sequence };

struct Field {
  std::string_view name;
  Kind kind;
  Arity arity;
  std::uint32_t size;        // elements of an array, else 1
  int type;                  // of a structure: index into all_types(), else -1
  std::string_view comment;  // unit and meaning, as idl/ has them
};

struct Type {
  std::string_view name;  // "goshawk_msgs/msg/Path"
  std::string_view comment;
  std::span<const Field> fields;
  std::uint32_t least_size;  // [byte] no value of this type is shorter in CDR
};

/// Every struct of idl/, inner ones before those that hold them.
std::span<const Type> all_types();

/// @param name "goshawk_msgs/msg/Path"; "goshawk_msgs/Path" will do
/// @return invalid_input that names the nearest type
Result<const Type*> find_type(std::string_view name);

/// @return [byte] alignment and size of a primitive; a string counts as its length field
std::uint32_t size_of(Kind kind);
/// @return as ROS spells it in .msg files: "float64"; empty for a structure
std::string_view ros_name(Kind kind);

/// The type as ROS 2 .msg text, each inner type behind a line of '=' and "MSG: package/Name": what
/// MCAP calls schema encoding "ros2msg".
std::string ros_msg_definition(const Type& type);
/// @return invalid_input that names the nearest type
Result<std::string> ros_msg_definition(std::string_view type_name);

}  // namespace goshawk::introspection
