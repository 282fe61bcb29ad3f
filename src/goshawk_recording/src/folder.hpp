#pragma once

#include <string>
#include <vector>

#include "goshawk/core/result.hpp"

namespace goshawk::recording {

/// The files of a recording.
struct Files {
  std::vector<std::string> paths;       // of .mcap files, in order; at least one
  std::vector<std::string> complaints;  // about files that are missing
};

/// @param path a file, which need not be there; or a folder with one .mcap file, or with a bag of
/// rosbag2, whose metadata.yaml lists them
/// @return invalid_input for a folder with none, with several that no metadata.yaml lists, or with
/// a bag in another format
Result<Files> recording_files(const std::string& path);

}  // namespace goshawk::recording
