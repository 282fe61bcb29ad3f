#pragma once

#include <set>
#include <string>
#include <string_view>

#include "goshawk/recording/reader.hpp"

namespace goshawk::recording {

/// The layout of a message in CDR: its primitives in order, "[3 float64]" for an array, "[* int8]"
/// for a sequence. Names, comments and constants do not count.
/// @param definition ROS 2 .msg text, inner types behind lines of '=' and "MSG: package/Name"
/// @return empty if the text refers to a type that it does not define
std::string layout_of_definition(std::string_view definition);

/// The same of a type that this version has: "goshawk_msgs/msg/Path". @return empty if it has none
std::string layout_of_type(std::string_view type_name);

/// Recordings carry the definition of every type. One whose layout is not ours, or a type of
/// goshawk_msgs that is not there any more, comes from another version of Goshawk: its bytes would
/// be read as something else.
/// @param channels of the reader
/// @return invalid_input with each such topic, its type, and what to do
Status check_layout(const Reader& reader, const std::set<std::uint16_t>& channels);

}  // namespace goshawk::recording
