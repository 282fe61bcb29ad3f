#include "flight/recorder_process.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>

namespace goshawk::cli {

Result<ChildVerb> start_recorder(const std::string& folder, int domain) {
  return ChildVerb::start({"record", "--overwrite", "-o", folder + "/flight.mcap"}, domain,
                          folder + "/logs/record.log");
}

bool hears_planning(const runtime::Context& context, pid_t recorder) {
  std::string prefix;
  for (const auto& participant : context.participants()) {
    if (participant.name == fmt::format("goshawk_{}", recorder)) prefix = participant.guid_prefix;
  }
  std::set<std::string> heard;
  for (const auto& endpoint : context.endpoints()) {
    if (!endpoint.writer && endpoint.participant == prefix) heard.insert(endpoint.topic);
  }
  static constexpr const char* kTopics[] = {"plan_request", "path", "corridor", "trajectory"};
  return std::ranges::all_of(kTopics, [&](const std::string& topic) {
    return std::ranges::any_of(heard, [&](const auto& h) { return h.ends_with("/" + topic); });
  });
}

}  // namespace goshawk::cli
