#include "goshawk/path_search/labels.hpp"

#include <sys/mman.h>

#include <algorithm>
#include <cstdlib>

#include "goshawk/path_search/populate.hpp"
#include "goshawk/path_search/tiled_labels.hpp"

namespace goshawk::path_search {
namespace {

constexpr std::size_t kLargePage = std::size_t{1} << 21;

}  // namespace

bool LabelMemory::resize(std::size_t labels) {
  labels_.reset();
  const std::size_t bytes = labels * sizeof(Label);
  void* memory = ::mmap(nullptr, bytes, PROT_READ | PROT_WRITE,
                        MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
  if (memory == MAP_FAILED) return false;
  // Only a wish: where large pages are off, small ones do. A short search needs a few small ones,
  // and would wait for a large one to be cleared.
  if (bytes >= 2 * kLargePage) {
    (void)::madvise(static_cast<char*>(memory) + kLargePage, bytes - kLargePage, MADV_HUGEPAGE);
  }
  labels_ = std::unique_ptr<Label, Unmap>(static_cast<Label*>(memory), Unmap{bytes});
  return true;
}

void LabelMemory::populate(std::size_t labels) {
  path_search::populate(labels_.get(),
                        std::min(labels * sizeof(Label), labels_.get_deleter().bytes));
}

bool LabelTable::resize(Index3, std::int64_t nodes) {
  nodes_ = nodes;
  query_ = 0;
  return memory_.resize(std::size_t(nodes));
}

bool LabelTable::start_query() {
  if (query_ == kLastQuery && !resize({}, nodes_)) return false;
  use(query_ + 1);
  return true;
}

bool TiledLabels::resize(Index3 size, std::int64_t) {
  const auto tiles = [](int voxels) { return std::size_t(voxels - 1) / 4 + 1; };
  size_ = size;
  tiles_x_ = tiles(size.x);
  tiles_y_ = tiles(size.y);
  query_ = 0;
  tiles_ = tiles_x_ * tiles_y_ * tiles(size.z);
  directory_.reset(static_cast<std::uint64_t*>(std::calloc(tiles_, sizeof(std::uint64_t))));
  return directory_ != nullptr && memory_.resize(tiles_ * 64);
}

void TiledLabels::populate() {
  path_search::populate(directory_.get(), tiles_ * sizeof(std::uint64_t));
  memory_.populate(kPopulated);
}

bool TiledLabels::start_query() {
  if (query_ == kLastQuery && !resize(size_, 0)) return false;
  use(query_ + 1);
  used_ = 0;  // what an earlier query left in a tile is worse than any label of this one
  return true;
}

void LabelMemory::Unmap::operator()(Label* labels) const {
  ::munmap(labels, bytes);
}

}  // namespace goshawk::path_search
