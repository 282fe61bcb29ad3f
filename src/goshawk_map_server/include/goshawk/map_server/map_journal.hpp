#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <tuple>
#include <vector>

#include "goshawk/core/grid_update.hpp"
#include "goshawk/core/result.hpp"
#include "goshawk/map_server/voxel_map.hpp"

namespace goshawk::map_server {

/// A brick as a journal has it: counted from the frame's origin, so that a window may move.
struct JournalBrick {
  Index3 corner;  // first voxel, from the one that begins at the origin of frame `map`
  Brick::Words raw{};
  Brick::Words known{};

  friend bool operator==(const JournalBrick&, const JournalBrick&) = default;
};

/// What a journal goes with: journals of another map are refused.
struct JournalIdentity {
  double resolution_m = 0.0;
  std::uint64_t base = 0;  // checksum_of() the map before the first scan

  friend bool operator==(const JournalIdentity&, const JournalIdentity&) = default;
};

std::uint64_t checksum_of(const RawVoxels& map);

struct JournalOrder {
  bool operator()(Index3 a, Index3 b) const {
    return std::tie(a.z, a.y, a.x) < std::tie(b.z, b.y, b.x);
  }
};

/// What is whole in a journal.
struct JournalContent {
  std::uint64_t version = 0;  // of the newest batch that is whole; 0: none
  std::map<Index3, JournalBrick, JournalOrder> bricks;  // the newest of each, by corner
  std::int64_t damaged = 0;  // entries that were changed or cut off, and all others of their batches
  std::size_t whole_bytes = 0;                          // a new batch follows here

  /// Writes the bricks into a map that covers them; those beyond it are left out.
  void write_into(RawVoxels& map) const;

  /// The map on a raster that also covers all bricks, unknown in between.
  /// @return map_too_large beyond max_voxels
  Result<RawVoxels> widened(const RawVoxels& map, std::int64_t max_voxels) const;
};

/// @param bytes of a whole file
/// @return map_malformed if it is no journal; invalid_input if it goes with another map
Result<JournalContent> read_journal(std::span<const std::byte> bytes,
                                    const JournalIdentity& identity);

/// The bricks of an update, as a journal has them. @pre each brings raw voxels
std::vector<JournalBrick> journal_bricks(const GridUpdate& update, const GridGeometry& geometry);

/// A file with what a live map has learnt, so that a server that was killed goes on with the map
/// that it had. Batches are appended; each entry has a checksum, a batch counts when all its entries
/// are whole. When most entries are obsolete, the file is written anew beside the old one; if that
/// fails, it is tried again when the file has grown.
///
/// Written without waiting for the disk: what a process has written outlives its death, not that of
/// the machine.
class MapJournal {
 public:
  /// A journal up to this is not worth being written anew.
  static constexpr std::size_t kSmall_bytes = 16 << 20;

  /// Opens a file, or makes one. @return io_failed; map_malformed or invalid_input as
  /// read_journal(), then the file is as before
  static Result<MapJournal> open(const std::string& path, const JournalIdentity& identity);
  /// Makes an empty one in place of whatever is there. @return io_failed
  static Result<MapJournal> create(const std::string& path, const JournalIdentity& identity);

  MapJournal(MapJournal&& other) noexcept;
  MapJournal& operator=(MapJournal&&) = delete;
  ~MapJournal();

  /// What the file held when it was opened.
  const JournalContent& content() const { return content_; }
  /// Frees that memory.
  void forget_content();

  /// All or nothing. @return io_failed, e.g. for a disk that is full; the next one may succeed
  Status append(std::uint64_t version, std::span<const JournalBrick> bricks);

 private:
  using Places = std::map<Index3, std::size_t, JournalOrder>;  // byte at which an entry begins

  MapJournal(std::string path, const JournalIdentity& identity, int file);
  Status compact();
  Status compact_file();

  std::string path_;
  JournalIdentity identity_;
  int file_ = -1;
  JournalContent content_;
  Places places_;         // of the newest entry of each brick
  std::size_t end_ = 0;   // [byte] of the file
  std::size_t next_compaction_ = kSmall_bytes;  // [byte] not before
};

}  // namespace goshawk::map_server
