#pragma once

#include <functional>
#include <map>
#include <string>
#include <vector>

#include "goshawk/recording/writer.hpp"

namespace goshawk::recording {

/// Takes sentences about what happens.
using Say = std::function<void(const std::string& sentence)>;

struct RecordOptions {
  std::vector<std::string> topics;   // names, or beginnings like /uav1/*; none: all
  std::vector<std::string> exclude;  // the same
  std::string file;
  bool overwrite = false;
  double duration_s = 0.0;  // 0: until Ctrl-C
  bool lock_step = false;   // take turns as node goshawk_record
};

/// What was recorded, and why it ended if that was a failure.
struct RecordEnd {
  Status state = success();
  WriterCounts counts;
  std::map<std::string, std::uint64_t> received;  // messages by topic
  double duration_s = 0.0;
};

/// Records topics of the domain to an MCAP file, until Ctrl-C or the end of the time.
/// @return why nothing was recorded: invalid_parameter, io_failed
Result<RecordEnd> record(const RecordOptions& options, const Say& say);

}  // namespace goshawk::recording
