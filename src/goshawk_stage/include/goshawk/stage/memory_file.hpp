#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "goshawk/core/result.hpp"

/// Files that a stage leaves for the one that is started in its place. A file is replaced as a
/// whole: a process that dies meanwhile leaves the old one or the new one. It outlives the process,
/// not a power cut.
namespace goshawk::stage {

using MemoryBytes = std::vector<unsigned char>;

/// The content between a line that says what it is and a checksum.
/// @param kind what it is, and its version
MemoryBytes framed(std::string_view kind, const MemoryBytes& content);
/// @return the content; io_failed: cut off, changed, or of another kind
Result<MemoryBytes> unframed(std::string_view kind, const MemoryBytes& bytes);

/// @return io_failed with the path
Status replace_file(const std::string& path, const MemoryBytes& bytes);
/// @return empty if there is no file; io_failed with the path
Result<MemoryBytes> read_file(const std::string& path);

}  // namespace goshawk::stage
