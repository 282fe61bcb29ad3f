#pragma once

#include <cstdint>
#include <fstream>
#include <string>
#include <utility>

#include "goshawk/core/result.hpp"
#include "goshawk_msgs.h"
#include "json.hpp"

namespace goshawk::cli {

/// What happens in a flight, as it happens: one JSON object a line in events.jsonl of the flight
/// folder (docs/cli.md). What repeats is written once.
class FlightEvents {
 public:
  /// @return io_failed if the file cannot be written
  static Result<FlightEvents> open(const std::string& file);

  /// @param at_ns when it was heard of, on the monotonic clock
  void add(std::int64_t at_ns, const std::string& event, Json what);
  void navigator(std::int64_t at_ns, const goshawk_msgs::msg::NavigatorState& m);
  /// A tracker's mode or trajectory that is another than before.
  void tracker(std::int64_t at_ns, const goshawk_msgs::msg::TrackingState& m);
  /// A fault, or that a stage is ready.
  void report(std::int64_t at_ns, const goshawk_msgs::msg::StageReport& m);

 private:
  explicit FlightEvents(std::ofstream file) : file_(std::move(file)) {}

  std::ofstream file_;
  Json navigator_;
  Json tracker_;
};

}  // namespace goshawk::cli
