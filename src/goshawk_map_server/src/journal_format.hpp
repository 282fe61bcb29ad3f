#pragma once

#include <array>
#include <cstring>
#include <span>

#include "goshawk/map_server/map_journal.hpp"

namespace goshawk::map_server {

/// A journal's file: a head, then entries of one size, little-endian, in batches: one batch is one
/// version of the map. Of a batch with a damaged entry nothing counts; other batches do.
inline constexpr std::array<char, 8> kJournalMagic{'G', 'O', 'S', 'J', 'R', 'N', 'L', '2'};

struct JournalHead {
  std::array<char, 8> magic = kJournalMagic;
  double resolution_m = 0.0;
  std::uint64_t base = 0;
  std::uint64_t checksum = 0;  // of what stands before
};
static_assert(sizeof(JournalHead) == 32);

struct JournalEntry {
  std::uint64_t version = 0;
  std::int32_t corner[3] = {};
  std::uint32_t number = 0;  // in its batch, from 0
  std::uint32_t count = 0;   // entries of the batch
  std::uint32_t unused = 0;
  std::uint64_t raw[Brick::kWords] = {};
  std::uint64_t known[Brick::kWords] = {};
  std::uint64_t checksum = 0;  // of what stands before
};
static_assert(sizeof(JournalEntry) == 40 + 2 * 8 * Brick::kWords);

/// FNV-1a over 64-bit words: tells damage, not intent. @param bytes a multiple of eight
std::uint64_t checksum_of_bytes(std::span<const std::byte> bytes, std::uint64_t seed = 0);

/// Of all but the checksum itself, which stands last.
template <typename Block>
std::uint64_t checksum_of_block(const Block& block) {
  return checksum_of_bytes(std::as_bytes(std::span(&block, 1)).first(sizeof block - 8));
}

JournalHead head_of(const JournalIdentity& identity);
JournalEntry entry_of(std::uint64_t version, const JournalBrick& brick, std::size_t number,
                      std::size_t count);

}  // namespace goshawk::map_server
