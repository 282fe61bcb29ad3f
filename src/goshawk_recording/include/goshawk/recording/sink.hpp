#pragma once

#include <memory>

#include "goshawk/core/result.hpp"
#include "goshawk/recording/format.hpp"

namespace goshawk::recording {

/// Where a recording goes: bytes at the end, and room for more kept ready.
class Sink {
 public:
  virtual ~Sink() = default;
  /// @return io_failed that says why; a part of the bytes may be there then
  virtual Status append(View bytes) = 0;
  /// Makes sure that `size` more bytes will fit. @return io_failed where they will not; success
  /// where that cannot be known
  virtual Status reserve(std::uint64_t size) = 0;
  /// Drops whatever lies behind the first `size` bytes.
  virtual Status cut(std::uint64_t size) = 0;
};

/// A new file. What append() took is the kernel's, so that it outlives this process' kill -9.
/// @return io_failed: the folder cannot be written, or the file exists and may not be replaced
Result<std::unique_ptr<Sink>> create_file(const std::string& path, bool overwrite = false);

}  // namespace goshawk::recording
