#pragma once

#include <memory>

#include "goshawk/core/result.hpp"
#include "goshawk/recording/format.hpp"

namespace goshawk::recording {

/// Where a recording is written: bytes are appended, and room for more can be reserved.
class Sink {
 public:
  virtual ~Sink() = default;
  /// @return io_failed; a part of the bytes may have been written
  virtual Status append(View bytes) = 0;
  /// Makes sure that `size` more bytes will fit. @return io_failed if they will not; success if
  /// that cannot be known
  virtual Status reserve(std::uint64_t size) = 0;
  /// Drops everything after the first `size` bytes.
  virtual Status cut(std::uint64_t size) = 0;
};

/// A new file. What append() took is in the kernel, so it survives kill -9 of this process.
/// @return io_failed: the folder cannot be written, or the file exists and may not be replaced
Result<std::unique_ptr<Sink>> create_file(const std::string& path, bool overwrite = false);

}  // namespace goshawk::recording
