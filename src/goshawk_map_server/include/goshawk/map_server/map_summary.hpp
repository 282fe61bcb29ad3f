#pragma once

#include <string>

#include "goshawk/map_server/map_file.hpp"

namespace goshawk::map_server {

/// What was read of a map, so that a user sees whether it is the one that he meant: its entries and
/// how many of them were left out, its extent, and the shares of occupied, free and unknown space.
/// One line.
/// @param raw the voxels of `source`
std::string summarise(const MapSource& source, const RawVoxels& raw);
/// The same of a map that no file was read for: extent and shares.
std::string summarise(const RawVoxels& raw);

}  // namespace goshawk::map_server
