#include "goshawk/path_search/populate.hpp"

#include <sys/mman.h>
#include <unistd.h>

#include <cstdint>

namespace goshawk::path_search {

void populate(void* memory, std::size_t bytes) {
#ifdef MADV_POPULATE_WRITE  // Linux 5.14 and later
  static const auto page = std::uintptr_t(::sysconf(_SC_PAGESIZE));
  const auto begin = (reinterpret_cast<std::uintptr_t>(memory) + page - 1) / page * page;
  const auto end = (reinterpret_cast<std::uintptr_t>(memory) + bytes) / page * page;
  if (begin >= end) return;
  (void)::madvise(reinterpret_cast<void*>(begin), end - begin, MADV_POPULATE_WRITE);
#else
  (void)memory;
  (void)bytes;
#endif
}

}  // namespace goshawk::path_search
