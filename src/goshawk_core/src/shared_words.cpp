#include "goshawk/core/shared_words.hpp"

#include <algorithm>
#include <new>

namespace goshawk {

SharedWords::SharedWords(std::size_t count, Word value) : words_(allocate(count)) {
  std::fill_n(words_, count, value);
}

SharedWords::Word* SharedWords::allocate(std::size_t count) {
  void* memory = ::operator new(sizeof(Header) + count * sizeof(Word));
  auto* header = new (memory) Header{1, count};
  return reinterpret_cast<Word*>(header + 1);
}

void SharedWords::release() {
  if (words_ == nullptr) return;
  Header* mine = header();
  if (mine->owners.fetch_sub(1, std::memory_order_acq_rel) != 1) return;
  mine->~Header();
  ::operator delete(mine);
}

void SharedWords::clone() {
  const std::size_t count = header()->count;
  Word* copy = allocate(count);
  std::copy_n(words_, count, copy);
  release();
  words_ = copy;
}

}  // namespace goshawk
