#pragma once

#include <octomap/octomap.h>

#include <filesystem>
#include <memory>
#include <string_view>

#include "goshawk/core/result.hpp"

namespace goshawk::flight_check {

/// @param file .bt (binary) or .ot (with probabilities)
/// @return map_unreadable, map_malformed or map_empty; never a tree that was read in part
Result<std::unique_ptr<octomap::OcTree>> read_octomap(const std::filesystem::path& file);

/// The tree of an octomap_msgs/Octomap that is binary: as in a .bt file, behind its header.
/// @return map_malformed or map_empty; never a tree that was read in part
Result<std::unique_ptr<octomap::OcTree>> read_payload(std::string_view payload,
                                                      double resolution_m);

/// Fills every gap of the tree, out to the end of its key space, with occupied leaves: unknown
/// becomes an obstacle. A gap is one leaf however large it is.
void occupy_unknown(octomap::OcTree& tree);

}  // namespace goshawk::flight_check
