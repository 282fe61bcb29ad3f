#pragma once

#include <cstdint>

#include "goshawk/core/result.hpp"
#include "goshawk/introspection/schema.hpp"
#include "goshawk/recording/format.hpp"

namespace goshawk::recording {

/// Adds shift_ns to every builtin_interfaces/Time in a CDR message, in place; a stamp of zero means
/// "none" and stays. All other bytes stay.
/// @return invalid_input if the bytes are not such a message; some stamps may have been shifted
Status shift_stamps(const introspection::Type& type, Bytes& message, std::int64_t shift_ns);

}  // namespace goshawk::recording
