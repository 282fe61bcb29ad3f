#pragma once

#include <string>
#include <vector>

#include "goshawk/core/result.hpp"

namespace goshawk::runtime {
class Context;
}  // namespace goshawk::runtime

namespace goshawk::conformance {

/// One thing that every implementation of a stage must do.
struct Item {
  std::string name;  // "echoes the request whole"
  bool passed = false;
  std::string detail;  // what was seen, or what is wrong and in which answer
};

struct Report {
  std::string stage;
  std::string implementation;  // from its reports
  std::vector<Item> items;
  double latency_p50_s = 0.0;  // of answered good requests, from sent to arrived
  double latency_p99_s = 0.0;
  double latency_max_s = 0.0;

  bool passed() const;
};

struct Options {
  std::string stage;  // path_search, corridor_builder, trajectory_optimizer, tracker, map_server
  std::string input = {};  // MCAP file with inputs to examine beside the generated ones; or none
  std::string node_namespace = "/";
  int requests = 40;       // good ones
  std::uint64_t seed = 1;  // of the world and the requests
  double timeout_s = 2.0;  // longest wait for an answer
  double ready_timeout_s = 20.0;
  bool fresh = true;  // the stage has seen no map yet
};

/// Stages that can be examined.
std::vector<std::string> stages();

/// Stands in for all neighbours of the stage: sends a map and requests, good and bad, and examines
/// every answer. Requests are the same for the same seed.
/// @return invalid_parameter for an unknown stage, stage_silent if no node reads its input within
/// ready_timeout_s, io_failed or invalid_input if the recording cannot be used
Result<Report> conform(runtime::Context& context, const Options& options);

}  // namespace goshawk::conformance
