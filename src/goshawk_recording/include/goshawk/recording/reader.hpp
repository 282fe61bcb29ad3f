#pragma once

#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <set>

#include "goshawk/core/result.hpp"
#include "goshawk/recording/format.hpp"

namespace goshawk::recording {

struct ReadOptions {
  std::uint64_t from_ns = 0;  // log time, both included
  std::uint64_t to_ns = std::numeric_limits<std::uint64_t>::max();
  std::optional<std::set<std::uint16_t>> channels = {};  // none: all
};

/// Reads MCAP files of any writer (chunks of zstd, lz4 or none), and bags of rosbag2: folders of
/// several such files. The bytes are not trusted: a length counts only as far as the file goes, an
/// index never. A file that is cut off gives everything that is whole in it; complaints() tell.
class Reader {
 public:
  /// @param path a file, or a folder that holds one recording. The channels of its second file and
  /// of those after it get new ids, unless the first has the same.
  /// @return io_failed if a file cannot be read, invalid_input if it is not an MCAP file
  static Result<Reader> open(const std::string& path);
  ~Reader();
  Reader(Reader&&) noexcept;
  Reader& operator=(Reader&&) noexcept;

  const std::string& profile() const;
  const std::map<std::uint16_t, Schema>& schemas() const;
  const std::map<std::uint16_t, Channel>& channels() const;
  /// @return the channel's schema, or nullptr
  const Schema* schema_of(const Channel& channel) const;
  std::uint64_t message_count() const;
  std::uint64_t message_count(std::uint16_t channel_id) const;
  std::uint64_t start_ns() const;  // log time of the first message; 0: there is none
  std::uint64_t end_ns() const;

  /// What is wrong with the file, one sentence each; empty for a whole file.
  const std::vector<std::string>& complaints() const;

  /// Gives messages in the order of their log times; equal ones in the order of the file.
  /// @param take the view ends with the call; @return false to end
  /// @return io_failed if the file can no longer be read. Damaged chunks are skipped and become
  /// complaints.
  Status read(const ReadOptions& options, const std::function<bool(const MessageView&)>& take);

 private:
  struct Impl;
  explicit Reader(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace goshawk::recording
