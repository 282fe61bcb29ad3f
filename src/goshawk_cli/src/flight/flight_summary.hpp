#pragma once

#include <optional>

#include "flight/flight_recorder.hpp"
#include "goshawk/flight_check/flight_check.hpp"
#include "json.hpp"

namespace goshawk::cli {

/// One goal of a flight and how it went.
struct LegOutcome {
  Vec3 goal_map = Vec3::Zero();
  std::uint64_t request_id = 0;
  bool arrived = false;
  std::string code;
  std::string message;
  double flight_time_s = 0.0;               // from the goal sent to arrived
  std::vector<std::uint64_t> commits = {};  // ids of what was committed on the way, in order
};

struct FlightOutcome {
  std::vector<LegOutcome> legs;
  std::int64_t end_ns = 0;       // when the last goal was reached or given up
  std::optional<Error> refusal;  // the call was wrong: nothing was flown
  Result<flight_check::Verdict> verdict = fail(ErrorCode::invalid_input, "not judged");

  bool all_arrived() const;
  bool touched() const { return !verdict.ok() || verdict->touched; }
  bool ok() const { return all_arrived() && !touched(); }
};

/// The whole flight as one object (docs/cli.md); the text summary is printed from it.
Json summary_json(const FlightOutcome& outcome, const FlightRecorder& record,
                  const std::string& folder);
void print_summary(const Json& summary);

}  // namespace goshawk::cli
