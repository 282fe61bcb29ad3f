#pragma once

#include "goshawk/recording/reader.hpp"

namespace goshawk::recording {

/// A line of JSON on stdout for each message of these channels: topic, type, log_time_s, bytes,
/// crc32 of the bytes, value (null where its type is not known here or the bytes are no such
/// message).
/// @return io_failed
Status print_messages(Reader& reader, const std::set<std::uint16_t>& channels);

}  // namespace goshawk::recording
