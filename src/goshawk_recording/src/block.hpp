#pragma once

#include <memory>

#include "goshawk/core/result.hpp"
#include "records.hpp"

namespace goshawk::recording {

/// A file with random access.
class File {
 public:
  static Result<File> open(const std::string& path);
  File(File&& other) noexcept
      : path_(std::move(other.path_)),
        descriptor_(std::exchange(other.descriptor_, -1)),
        size_(other.size_) {}
  File& operator=(File&&) = delete;
  ~File();

  std::uint64_t size() const { return size_; }
  /// @pre it lies in the file. @return io_failed
  Result<Bytes> read(std::uint64_t at, std::uint64_t size) const;

 private:
  File(std::string path, int descriptor, std::uint64_t size)
      : path_(std::move(path)), descriptor_(descriptor), size_(size) {}

  std::string path_;
  int descriptor_;
  std::uint64_t size_;  // [byte] when it was opened
};

/// Messages that are stored together: a chunk, or neighbours outside chunks.
struct Block {
  std::uint64_t offset = 0;  // [byte] in the file, of the records
  std::uint64_t size = 0;    // [byte] there
  std::uint64_t start_ns = 0, end_ns = 0;
  std::uint64_t uncompressed_size = 0;
  std::uint32_t crc = 0;  // of the records, uncompressed; 0: not known
  std::string compression = {};
};

/// The chunk whose record's content begins with `head` and is `size` bytes long, at `offset` of
/// the file. @return nothing if that is not a chunk
std::optional<Block> chunk_of(View head, std::uint64_t offset, std::uint64_t size);

/// The records of a block. @return invalid_input if they are damaged: a wrong CRC or size,
/// or an unknown compression; io_failed
Result<Bytes> load(const File& file, const Block& block);

/// Calls take(opcode, content) for each record. @return whether the bytes are whole records
template <typename Take>
bool for_each_record(View records, Take&& take) {
  In in(records);
  while (in.left() > 0) {
    const auto opcode = Opcode(in.number<std::uint8_t>());
    const View content = in.raw(in.number<std::uint64_t>());
    if (!in.good()) return false;
    take(opcode, content);
  }
  return true;
}

}  // namespace goshawk::recording
