#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "goshawk/map_server/config.hpp"
#include "goshawk/map_server/live_map.hpp"
#include "journal_thread.hpp"

namespace goshawk::map_server {

/// What a map server begins with: the map file or unknown space, and what an earlier life has left
/// in the journal.
struct Beginning {
  LiveMap map;
  std::uint64_t versions_before = 0;  // [versions] to be added: no version is used for two maps
  std::unique_ptr<JournalThread> journal{};  // null: none is asked for, or it cannot be written
  std::size_t bricks = 0;                    // from the journal
  std::vector<std::string> notes{};          // what was assumed of the map file
  std::optional<Error> journal_fault{};      // of an old journal, or of making a new one
};

/// @param now_ns [ns since 1970] of the machine's clock. A map without a journal, or with one that is
/// new, begins with version 1; any other at the clock's milliseconds or beyond the journal's versions
/// @return as load_map(), LiveMap::from_source() and LiveMap::unknown_space(). A journal that is
/// damaged or goes with another map is no failure: what is whole of it is used
Result<Beginning> begin_map(const Config& config, std::int64_t now_ns);

}  // namespace goshawk::map_server
