#include "goshawk/path_search/labels.hpp"

#include <sys/mman.h>

namespace goshawk::path_search {
namespace {

constexpr std::size_t kLargePage = std::size_t{1} << 21;

}  // namespace

bool LabelTable::resize(std::int64_t nodes) {
  labels_.reset();
  nodes_ = 0;
  query_ = 0;
  const std::size_t bytes = std::size_t(nodes) * sizeof(Label);
  void* memory = ::mmap(nullptr, bytes, PROT_READ | PROT_WRITE,
                        MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
  if (memory == MAP_FAILED) return false;
  // Only a wish: where large pages are off, small ones do.
  if (bytes >= 2 * kLargePage) (void)::madvise(memory, bytes, MADV_HUGEPAGE);
  labels_ = std::unique_ptr<Label, Unmap>(static_cast<Label*>(memory), Unmap{bytes});
  nodes_ = nodes;
  return true;
}

void LabelTable::Unmap::operator()(Label* labels) const {
  ::munmap(labels, bytes);
}

}  // namespace goshawk::path_search
