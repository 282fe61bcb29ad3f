#pragma once

#include <string>
#include <vector>

#include "goshawk/navigator/navigator.hpp"
#include "goshawk_msgs.h"

namespace goshawk::navigator {

/// A leg as it was published.
using PublishedLeg = goshawk_msgs::msg::CommittedTrajectory;

/// What is kept in the file: Memory, with legs as messages, for others read them.
struct StoredMemory {
  Memory memory = {};  // without legs
  std::vector<PublishedLeg> legs = {};
};

/// The bytes of the file, and back.
/// @return io_failed: cut off, changed, or of another version
std::vector<unsigned char> to_bytes(const StoredMemory& stored);
Result<StoredMemory> from_bytes(const std::vector<unsigned char>& bytes);

/// Replaces the file as a whole: a process that dies meanwhile leaves the old file or the new one.
/// @return io_failed with the path
Status write_memory(const std::string& path, const StoredMemory& stored);
/// @return io_failed; the memory of a navigator that has done nothing if there is no file
Result<StoredMemory> read_memory(const std::string& path);

}  // namespace goshawk::navigator
