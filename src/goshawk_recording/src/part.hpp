#pragma once

#include <map>
#include <string>
#include <vector>

#include "block.hpp"

namespace goshawk::recording {

/// One MCAP file: where its messages lie, and what they are. What Reader says of a recording, of
/// this file alone.
struct Part {
  /// @return io_failed if the file cannot be read, invalid_input if it is not an MCAP file
  static Result<Part> open(const std::string& path);

  File file;
  std::string profile = {};
  std::map<std::uint16_t, Schema> schemas = {};
  std::map<std::uint16_t, Channel> channels = {};
  std::vector<Block> blocks = {};
  std::map<std::uint16_t, std::uint64_t> counts = {};  // of messages, by channel
  std::uint64_t total = 0, start_ns = 0, end_ns = 0;
  std::vector<std::string> complaints = {};

  void complain(std::string sentence);
};

}  // namespace goshawk::recording
