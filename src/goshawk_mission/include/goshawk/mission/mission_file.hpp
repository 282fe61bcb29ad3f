#pragma once

#include <string>
#include <vector>

#include "goshawk/mission/mission.hpp"

namespace goshawk::mission {

/// A mission as a file says it (docs/missions.md).
struct MissionFile {
  Mission mission;         // its name is the file's own, or else the path
  std::vector<int> lines;  // of each waypoint, counted from 1: for what is wrong with it
};

/// Reads .yaml, .yml or .csv. Nothing of a file with one fault is used.
/// @return io_failed: not readable; invalid_input: "FILE, line N: REASON"
Result<MissionFile> read_mission(const std::string& path);

/// The same for a text. @param path for the name and the sentences; its ending decides
Result<MissionFile> parse_mission(const std::string& path, const std::string& text);

}  // namespace goshawk::mission
