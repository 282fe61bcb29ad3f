#include "qos_profiles.hpp"

#include <sstream>

namespace goshawk::recording {
namespace {

// rmw's numbers
constexpr int kHistoryUnknown = 3;
constexpr int kReliable = 1, kBestEffort = 2;
constexpr int kTransientLocal = 1, kVolatile = 2;
constexpr int kLivelinessAutomatic = 1;

std::string endless(const std::string& name) {
  return "  " + name + ":\n    sec: 9223372036\n    nsec: 854775807\n";
}

}  // namespace

std::string to_profiles(const std::vector<runtime::EndpointInfo>& writers) {
  std::ostringstream yaml;
  for (const auto& writer : writers) {
    yaml << "- history: " << kHistoryUnknown
         << "\n  depth: 0\n  reliability: " << (writer.reliable ? kReliable : kBestEffort)
         << "\n  durability: " << (writer.transient_local ? kTransientLocal : kVolatile) << "\n"
         << endless("deadline") << endless("lifespan") << "  liveliness: " << kLivelinessAutomatic
         << "\n"
         << endless("liveliness_lease_duration") << "  avoid_ros_namespace_conventions: false\n";
  }
  return yaml.str();
}

runtime::Qos offered_by_player(const std::string& profiles) {
  runtime::Qos qos = runtime::Qos::best_effort(100);
  bool known = false;
  std::istringstream lines(profiles);
  for (std::string line; std::getline(lines, line);) {
    const auto from = line.find_first_not_of(" -");
    const auto colon = line.find(": ");
    if (from == std::string::npos || colon == std::string::npos || colon < from) continue;
    const std::string key = line.substr(from, colon - from);
    const std::string value = line.substr(colon + 2);
    if (key == "reliability") {
      known = true;
      if (value == "1" || value == "reliable") qos.reliable = true;
    }
    if (key == "durability" && (value == "1" || value == "transient_local")) {
      qos.transient_local = true;
    }
  }
  if (!known) qos.reliable = true;
  return qos;
}

}  // namespace goshawk::recording
