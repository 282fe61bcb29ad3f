#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "goshawk/movers/mover.hpp"

namespace goshawk::movers {

/// Reads what moves in a world (docs/movers.md has the keys). Files of tracks are looked for beside
/// the file.
/// @return io_failed if the file cannot be read; invalid_input with the file's name, the line and
/// the reason, also for a track that cannot be read
Result<std::vector<Mover>> read_movers(const std::filesystem::path& file);

/// The same from a text. @param name for errors, and the folder in which tracks are looked for
Result<std::vector<Mover>> parse_movers(const std::filesystem::path& name, const std::string& text);

}  // namespace goshawk::movers
