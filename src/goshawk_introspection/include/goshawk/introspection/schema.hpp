#pragma once

#include <span>
#include <string>
#include <string_view>

#include "goshawk/core/result.hpp"
#include "goshawk/runtime/schema.hpp"

namespace goshawk::introspection {

using runtime::schema::Arity;
using runtime::schema::Field;
using runtime::schema::Kind;
using runtime::schema::size_of;
using runtime::schema::Type;

/// Every struct of idl/, inner ones before those that hold them.
inline std::span<const Type> all_types() {
  return runtime::schema::types();
}

/// @param name "goshawk_msgs/msg/Path"; "goshawk_msgs/Path" will do
/// @return invalid_input that names the nearest type
Result<const Type*> find_type(std::string_view name);

/// @return the ROS name, as in .msg files: "float64"; empty for a structure
std::string_view ros_name(Kind kind);

/// The type as ROS 2 .msg text, each inner type after a line of '=' and "MSG: package/Name": MCAP's
/// schema encoding "ros2msg".
std::string ros_msg_definition(const Type& type);
/// @return invalid_input that names the nearest type
Result<std::string> ros_msg_definition(std::string_view type_name);

}  // namespace goshawk::introspection
