#pragma once

#include <string>
#include <vector>

#include "goshawk/mission/executor.hpp"

namespace goshawk::mission {

/// The bytes of the memory file, and back. @return io_failed: not such bytes, or not to be flown
std::vector<unsigned char> to_bytes(const Memory& memory);
Result<Memory> from_bytes(const std::vector<unsigned char>& bytes);

/// @return io_failed with the path
Status write_memory(const std::string& path, const Memory& memory);
/// @return the memory of a stage that has flown nothing if there is no file; io_failed
Result<Memory> read_memory(const std::string& path);

}  // namespace goshawk::mission
