#include "journal_format.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>

namespace goshawk::map_server {
namespace {

constexpr int kFarthest = 1 << 26;  // [voxels] from the origin of the frame; beyond lies no map

static_assert(std::endian::native == std::endian::little, "journals are little-endian");

/// Collects the entries of a batch until all are there.
class BatchReader {
 public:
  explicit BatchReader(JournalContent& content) : content_(content) {}

  void add(const JournalEntry& entry, std::size_t end) {
    if (!follows(entry)) drop();
    batch_.push_back(entry);
    if (entry.number + 1 < entry.count) return;
    if (batch_.size() != entry.count) return drop();
    for (const JournalEntry& e : batch_) {
      JournalBrick brick{{e.corner[0], e.corner[1], e.corner[2]}};
      std::ranges::copy(e.raw, brick.raw.begin());
      std::ranges::copy(e.known, brick.known.begin());
      content_.bricks[brick.corner] = brick;
    }
    content_.version = std::max(content_.version, entry.version);
    content_.whole_bytes = end;
    batch_.clear();
  }

  // Of a batch that lacks an entry nothing counts: its bricks belong together.
  void drop() {
    content_.damaged += std::int64_t(batch_.size());
    batch_.clear();
  }

 private:
  // A batch whose first entries are missing goes on, too: it is dropped at its end.
  bool follows(const JournalEntry& entry) const {
    if (batch_.empty()) return true;
    const JournalEntry& last = batch_.back();
    return entry.version == last.version && entry.count == last.count &&
           entry.number == last.number + 1;
  }

  JournalContent& content_;
  std::vector<JournalEntry> batch_;
};

bool is_whole(const JournalEntry& entry) {
  return entry.checksum == checksum_of_block(entry) &&
         std::ranges::all_of(entry.corner, [](int v) { return v >= -kFarthest && v <= kFarthest; });
}

Status check_head(const JournalHead& head, const JournalIdentity& identity) {
  if (head.magic != kJournalMagic || head.checksum != checksum_of_block(head)) {
    return fail(ErrorCode::map_malformed, "it is no journal of a map, or its head is damaged");
  }
  if (JournalIdentity{head.resolution_m, head.base} == identity) return success();
  return fail(ErrorCode::invalid_input,
              fmt::format("it goes with another map, or with another box or resolution ({:g} m; now "
                          "{:g} m)",
                          head.resolution_m, identity.resolution_m));
}

}  // namespace

std::uint64_t checksum_of_bytes(std::span<const std::byte> bytes, std::uint64_t seed) {
  std::uint64_t sum = 0xcbf29ce484222325ULL ^ seed;
  for (std::size_t at = 0; at + 8 <= bytes.size(); at += 8) {
    std::uint64_t word;
    std::memcpy(&word, bytes.data() + at, 8);
    sum = std::rotl((sum ^ word) * 0x100000001b3ULL, 23);
  }
  return sum;
}

std::uint64_t checksum_of(const RawVoxels& map) {
  const GridGeometry& g = map.geometry;
  const std::array<double, 7> shape{g.origin_map.x(), g.origin_map.y(), g.origin_map.z(),
                                    g.resolution_m,   double(g.size.x), double(g.size.y),
                                    double(g.size.z)};
  std::uint64_t sum = checksum_of_bytes(std::as_bytes(std::span(shape)));
  for (const BitGrid* bits : {&map.occupied, &map.known}) {
    for (int z = 0; z < bits->size().z; ++z) {
      for (int y = 0; y < bits->size().y; ++y) {
        const std::span row(bits->row(y, z), bits->words_per_row());
        sum = checksum_of_bytes(std::as_bytes(row), sum);
      }
    }
  }
  return sum;
}

JournalHead head_of(const JournalIdentity& identity) {
  JournalHead head{.resolution_m = identity.resolution_m, .base = identity.base};
  head.checksum = checksum_of_block(head);
  return head;
}

JournalEntry entry_of(std::uint64_t version, const JournalBrick& brick, std::size_t number,
                      std::size_t count) {
  JournalEntry entry{.version = version,
                     .corner = {brick.corner.x, brick.corner.y, brick.corner.z},
                     .number = std::uint32_t(number),
                     .count = std::uint32_t(count)};
  std::ranges::copy(brick.raw, entry.raw);
  std::ranges::copy(brick.known, entry.known);
  entry.checksum = checksum_of_block(entry);
  return entry;
}

Result<JournalContent> read_journal(std::span<const std::byte> bytes,
                                    const JournalIdentity& identity) {
  JournalHead head;
  if (bytes.size() < sizeof head) {
    return fail(ErrorCode::map_malformed, "it is no journal of a map: too short");
  }
  std::memcpy(&head, bytes.data(), sizeof head);
  if (auto status = check_head(head, identity); !status) return status.error();
  JournalContent content;
  content.whole_bytes = sizeof head;
  BatchReader batches(content);
  for (std::size_t at = sizeof head; at < bytes.size(); at += sizeof(JournalEntry)) {
    JournalEntry entry;
    const bool cut_off = bytes.size() - at < sizeof entry;
    if (!cut_off) std::memcpy(&entry, bytes.data() + at, sizeof entry);
    if (cut_off || !is_whole(entry)) {
      batches.drop();
      ++content.damaged;
      if (cut_off) break;
    } else {
      batches.add(entry, at + sizeof entry);
    }
  }
  batches.drop();
  return content;
}

void JournalContent::write_into(RawVoxels& map) const {
  const Vec3 steps = (map.geometry.origin_map / map.geometry.resolution_m).array().round().matrix();
  for (const auto& [corner, brick] : bricks) {
    const Index3 at{corner.x - int(steps.x()), corner.y - int(steps.y()),
                    corner.z - int(steps.z())};
    for (int bit = 0; bit < Brick::kSizeX * Brick::kWords; ++bit) {
      const int word = bit / Brick::kSizeX, x = bit % Brick::kSizeX;
      const Index3 voxel{at.x + x, at.y + word % Brick::kSizeY, at.z + word / Brick::kSizeY};
      if (!map.known.contains(voxel)) continue;
      map.occupied.set(voxel, brick.raw[std::size_t(word)] >> x & 1);
      map.known.set(voxel, brick.known[std::size_t(word)] >> x & 1);
    }
  }
}

Result<RawVoxels> JournalContent::widened(const RawVoxels& map, std::int64_t max_voxels) const {
  const GridGeometry& old = map.geometry;
  const Vec3 steps = (old.origin_map / old.resolution_m).array().round().matrix();
  const Index3 begin{int(steps.x()), int(steps.y()), int(steps.z())};
  Index3 lower = begin, upper = begin + old.size;
  for (const auto& [corner, brick] : bricks) {
    lower = {std::min(lower.x, corner.x), std::min(lower.y, corner.y), std::min(lower.z, corner.z)};
    upper = {std::max(upper.x, corner.x + Brick::kSizeX), std::max(upper.y, corner.y + Brick::kSizeY),
             std::max(upper.z, corner.z + Brick::kSizeZ)};
  }
  const Box box{old.resolution_m * Vec3(lower.x, lower.y, lower.z),
                old.resolution_m * Vec3(upper.x, upper.y, upper.z)};
  const auto raster = raster_of(box, old.resolution_m, max_voxels);
  if (!raster) return raster.error();
  RawVoxels wide{*raster, BitGrid(raster->size, true), BitGrid(raster->size, false)};
  for (int z = 0; z < old.size.z; ++z) {
    for (int y = 0; y < old.size.y; ++y) {
      for (int x = 0; x < old.size.x; ++x) {
        if (!map.known.get({x, y, z})) continue;
        const Index3 at{x + begin.x - lower.x, y + begin.y - lower.y, z + begin.z - lower.z};
        wide.known.set(at, true);
        wide.occupied.set(at, map.occupied.get({x, y, z}));
      }
    }
  }
  return wide;
}

std::vector<JournalBrick> journal_bricks(const GridUpdate& update, const GridGeometry& geometry) {
  const Vec3 steps = (geometry.origin_map / geometry.resolution_m).array().round().matrix();
  std::vector<JournalBrick> bricks;
  bricks.reserve(update.bricks.size());
  for (const Brick& brick : update.bricks) {
    bricks.push_back({{int(steps.x()) + brick.index.x * Brick::kSizeX,
                       int(steps.y()) + brick.index.y * Brick::kSizeY,
                       int(steps.z()) + brick.index.z * Brick::kSizeZ},
                      brick.raw.value(),
                      brick.known});
  }
  return bricks;
}

}  // namespace goshawk::map_server
