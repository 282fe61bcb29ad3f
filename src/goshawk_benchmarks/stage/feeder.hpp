#pragma once

#include <string>
#include <vector>

#include "goshawk/core/result.hpp"
#include "goshawk/recording/reader.hpp"

namespace goshawk::bench {

struct FeedOptions {
  std::string stage, input;  // input: an MCAP file
  int count = 200;
  double rate_hz = 0.0;    // requests a second, answered or not; 0: one when the last is answered
  double timeout_s = 2.0;  // then a request is lost
  int domain = 0;
};

/// Of each answered request. [us]
struct FeedSamples {
  std::vector<double> compute_us, wire_us, total_us;
  int sent = 0;
  int refused = 0;  // answered with a code
  int lost = 0;     // not answered
  double elapsed_s = 0.0;
};

/// Stages that can be fed.
std::vector<std::string> fed_stages();

/// Feeds recorded inputs to a stage over DDS, in turn, with ids and stamps of its own.
/// @param command of the stage; empty: our component, in a thread of this process
/// @return invalid_input if the recording lacks the stage's inputs, stage_silent where nobody
/// reads them
Result<FeedSamples> feed(const FeedOptions& options, const std::string& command,
                         recording::Reader& reader);

}  // namespace goshawk::bench
