#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "goshawk/core/result.hpp"
#include "goshawk/recording/format.hpp"
#include "goshawk/recording/sink.hpp"

namespace goshawk::recording {

struct WriterOptions {
  std::string profile = "ros2";
  std::string library = "goshawk";
  std::size_t chunk_bytes = 1 << 20;  // [byte] of messages after which a chunk is closed
  int compression_level = 1;          // of zstd; 0: not compressed
};

struct WriterCounts {
  std::uint64_t messages = 0;  // in the file
  std::uint64_t lost = 0;      // taken, but could not be written
  std::uint64_t bytes = 0;     // [byte] of the file
};

/// Writes an MCAP file: chunks compressed with zstd, each followed by its message indices, and at
/// the end a summary with the chunk indices. After flush() every message so far is in the file,
/// and a reader finds it even if the summary is never written.
///
/// Room for the summary is reserved before each chunk, so that a full disk leaves a whole file.
class Writer {
 public:
  /// @return io_failed if the sink does not take the first bytes
  static Result<Writer> create(std::unique_ptr<Sink> sink, const WriterOptions& options = {});
  ~Writer();
  Writer(Writer&&) noexcept;
  Writer& operator=(Writer&&) noexcept;

  /// @return the new schema's id. @throws std::length_error beyond 65535 of them
  std::uint16_t add_schema(std::string name, std::string encoding, std::string data);
  /// @param channel with schema_id as add_schema gave it, or 0 for none; its own id is ignored
  /// @return the new channel's id. @throws std::length_error, std::invalid_argument
  std::uint16_t add_channel(Channel channel);

  /// @return io_failed once the sink has failed: no more messages are taken then
  /// @throws std::invalid_argument for a channel that was never added
  Status write(const MessageView& message);

  /// Closes the chunk: everything written so far is in the sink.
  Status flush();

  /// Flushes and writes the summary. After a failure of the sink, everything that was whole before
  /// is kept and closed. @return the first failure, if there was one
  Status close();

  WriterCounts counts() const;

 private:
  struct Impl;
  explicit Writer(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace goshawk::recording
