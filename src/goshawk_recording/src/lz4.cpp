#include "lz4.hpp"

#include <lz4frame.h>

#include <algorithm>
#include <memory>
#include <new>

namespace goshawk::recording {
namespace {

constexpr std::size_t kStep = 64 << 10;  // [byte]

struct Free {
  void operator()(LZ4F_dctx* context) const { LZ4F_freeDecompressionContext(context); }
};

std::unique_ptr<LZ4F_dctx, Free> make_context() {
  LZ4F_dctx* context = nullptr;
  if (LZ4F_isError(LZ4F_createDecompressionContext(&context, LZ4F_VERSION))) {
    throw std::bad_alloc();
  }
  return std::unique_ptr<LZ4F_dctx, Free>(context);
}

Error damaged(std::string what) {
  return fail(ErrorCode::invalid_input, std::move(what));
}

}  // namespace

Result<Bytes> unpack_lz4(View packed, std::size_t most) {
  const auto context = make_context();
  Bytes out;
  for (std::size_t filled = 0, read = 0;;) {
    // One byte beyond what is allowed shows that there is more.
    if (filled == out.size()) out.resize(std::min(most + 1, 2 * out.size() + kStep));
    const std::size_t room = out.size() - filled;
    std::size_t written = room, taken = packed.size() - read;
    const std::size_t left = LZ4F_decompress(context.get(), out.data() + filled, &written,
                                             packed.data() + read, &taken, nullptr);
    if (LZ4F_isError(left)) return damaged(LZ4F_getErrorName(left));
    filled += written;
    read += taken;
    if (filled > most) return damaged("it holds more than it claims");
    if (read < packed.size() || written == room) continue;
    if (left != 0) return damaged("an LZ4 frame is cut off");
    out.resize(filled);
    return out;
  }
}

}  // namespace goshawk::recording
