#include "block.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>
#include <zstd.h>

#include <cerrno>

#include "lz4.hpp"

namespace goshawk::recording {
namespace {

// [byte] a chunk that claims more is refused: a few bytes can unpack to any size.
constexpr std::uint64_t kMostInChunk = 1ULL << 30;

Error damaged(const Block& block, const std::string& what) {
  return fail(ErrorCode::invalid_input,
              fmt::format("the chunk at byte {} is damaged: {}", block.offset, what));
}

// Grows with what is unpacked, not with what is claimed.
Result<Bytes> unpack_zstd(const Block& block, View packed) {
  const std::unique_ptr<ZSTD_DCtx, decltype(&ZSTD_freeDCtx)> context(ZSTD_createDCtx(),
                                                                     &ZSTD_freeDCtx);
  constexpr std::size_t kStep = 64 << 10;
  // One byte beyond what is claimed shows that there is more.
  const auto most = std::size_t(block.uncompressed_size) + 1;
  Bytes out;
  ZSTD_inBuffer in{packed.data(), packed.size(), 0};
  for (std::size_t filled = 0;;) {
    if (filled == out.size()) out.resize(std::min(most, 2 * out.size() + kStep));
    ZSTD_outBuffer to{out.data(), out.size(), filled};
    const std::size_t left = ZSTD_decompressStream(context.get(), &to, &in);
    if (ZSTD_isError(left)) return damaged(block, ZSTD_getErrorName(left));
    const bool more_room = to.pos < to.size;
    filled = to.pos;
    if (filled == most) return damaged(block, "it holds more than it claims");
    if (left == 0 || (more_room && in.pos == in.size)) {
      out.resize(filled);  // the caller notices if there are fewer than claimed
      return out;
    }
  }
}

// @return also records of another size than the block claims: fewer
Result<Bytes> unpack(const Block& block, View packed) {
  if (block.compression == "zstd") return unpack_zstd(block, packed);
  auto records = unpack_lz4(packed, std::size_t(block.uncompressed_size));
  if (!records) return damaged(block, records.error().message);
  return records;
}

}  // namespace

Result<File> File::open(const std::string& path) {
  const int descriptor = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  struct stat status {};
  if (descriptor < 0 || fstat(descriptor, &status) != 0) {
    const Error error =
        fail(ErrorCode::io_failed, path + " cannot be opened: " + std::strerror(errno));
    if (descriptor >= 0) ::close(descriptor);
    return error;
  }
  File file(path, descriptor, std::uint64_t(status.st_size));
  if (!S_ISREG(status.st_mode)) return fail(ErrorCode::io_failed, path + " is not a file");
  return file;
}

File::~File() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

Result<Bytes> File::read(std::uint64_t at, std::uint64_t size) const {
  Bytes bytes(std::size_t(std::min(size, size_ - std::min(at, size_))));
  for (std::size_t done = 0; done < bytes.size();) {
    const ssize_t got =
        pread(descriptor_, bytes.data() + done, bytes.size() - done, off_t(at + done));
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) {
      return fail(
          ErrorCode::io_failed,
          path_ + " cannot be read: " + (got == 0 ? "it became shorter" : std::strerror(errno)));
    }
    done += std::size_t(got);
  }
  return bytes;
}

std::optional<Block> chunk_of(View head, std::uint64_t offset, std::uint64_t size) {
  In in(head);
  Block block;
  block.start_ns = in.number<std::uint64_t>();
  block.end_ns = in.number<std::uint64_t>();
  block.uncompressed_size = in.number<std::uint64_t>();
  block.crc = in.number<std::uint32_t>();
  block.compression = in.text();
  block.size = in.number<std::uint64_t>();
  block.offset = offset + in.at();
  if (!in.good() || block.size != size - in.at()) return {};
  return block;
}

Result<Bytes> load(const File& file, const Block& block) {
  const bool known = block.compression == "zstd" || block.compression == "lz4";
  if (!block.compression.empty() && !known) {
    return damaged(block, fmt::format("its compression '{}' is not supported: zstd, lz4 and none "
                                      "are",
                                      block.compression));
  }
  if (block.uncompressed_size > kMostInChunk) {
    return damaged(block, fmt::format("it claims {} bytes", block.uncompressed_size));
  }
  auto packed = file.read(block.offset, block.size);
  if (!packed) return packed;
  auto records = block.compression.empty() ? std::move(packed) : unpack(block, *packed);
  if (!records) return records;
  if (records->size() != block.uncompressed_size)
    return damaged(block, "its size differs from what it claims");
  if (block.crc != 0 && crc32_of(*records) != block.crc)
    return damaged(block, "its CRC does not match");
  return records;
}

}  // namespace goshawk::recording
