// Any bytes as the journal of a map, and bytes of a good journal that were changed: refused with a
// sentence, or what is whole of it. Each three bytes write one byte of a good journal.
#include <cstdlib>
#include <vector>

#include "../src/journal_format.hpp"
#include "goshawk/map_server/map_journal.hpp"

namespace {

using namespace goshawk;
using namespace goshawk::map_server;

constexpr JournalIdentity kIdentity{0.2, 5};

std::vector<std::byte> good_journal() {
  std::vector<std::byte> bytes;
  const auto put = [&](const auto& block) {
    const auto all = std::as_bytes(std::span(&block, 1));
    bytes.insert(bytes.end(), all.begin(), all.end());
  };
  put(head_of(kIdentity));
  JournalBrick brick;
  brick.raw[3] = 7;
  brick.known[3] = 0xFF;
  put(entry_of(1, brick, 0, 2));
  brick.corner = {64, -8, 0};
  put(entry_of(1, brick, 1, 2));
  put(entry_of(2, brick, 0, 1));
  return bytes;
}

void judge(std::span<const std::byte> bytes) {
  const auto content = read_journal(bytes, kIdentity);
  if (!content) {
    if (content.error().message.empty()) std::abort();
    return;
  }
  if (content->whole_bytes > bytes.size() || content->damaged < 0) std::abort();
  const GridGeometry geometry{Vec3::Zero(), 0.2, {100, 9, 9}};
  RawVoxels voxels{geometry, BitGrid(geometry.size, true), BitGrid(geometry.size, false)};
  content->write_into(voxels);
  if (voxels.known.count() > voxels.known.voxels()) std::abort();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const std::vector<std::byte> good = good_journal();
  std::vector<std::byte> bytes = good;
  for (std::size_t k = 0; k + 3 <= size; k += 3) {
    bytes[(data[k] + 256U * data[k + 1]) % bytes.size()] = std::byte(data[k + 2]);
  }
  if (size % 3 == 1) bytes.resize(data[size - 1] * bytes.size() / 256);  // cut off
  judge(bytes);
  judge(std::as_bytes(std::span(data, size)));
  return 0;
}
