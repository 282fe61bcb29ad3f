#include "replan/scan_to_commit.hpp"

#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <stdexcept>
#include <thread>

#include "common/child.hpp"
#include "goshawk/runtime/message_type.hpp"
#include "goshawk/runtime/private_domain.hpp"
#include "goshawk_msgs.h"

namespace goshawk::bench {
namespace {

namespace fs = std::filesystem;
namespace msg = goshawk_msgs::msg;

constexpr auto kFlight = std::chrono::minutes(4);  // it hangs if it takes longer

enum class Kind { scan, update, commit };

struct Event {
  std::uint64_t ns;
  Kind kind;
  std::uint64_t version;  // of the map; of a scan 0
};

template <typename Message>
std::optional<Message> message_of(const recording::MessageView& view) {
  Message message;
  if (!runtime::decode<Message>({view.data.begin(), view.data.end()}, message)) return {};
  return message;
}

// In the order in which they were sent.
Result<std::vector<Event>> events_of(recording::Reader& reader) {
  std::map<std::uint16_t, Kind> kinds;
  for (const auto& [id, channel] : reader.channels()) {
    if (channel.topic.ends_with("/points")) kinds[id] = Kind::scan;
    if (channel.topic.ends_with("/map/voxels/updates")) kinds[id] = Kind::update;
    if (channel.topic.ends_with("/committed_trajectory")) kinds[id] = Kind::commit;
  }
  std::vector<Event> events;
  const auto read = reader.read({}, [&](const recording::MessageView& m) {
    const auto kind = kinds.find(m.channel_id);
    if (kind == kinds.end()) return true;
    std::uint64_t version = 0;
    if (kind->second == Kind::update) {
      const auto update = message_of<msg::VoxelGridUpdate>(m);
      if (!update) return true;
      version = update->to_version();
    } else if (kind->second == Kind::commit) {
      const auto commit = message_of<msg::CommittedTrajectory>(m);
      if (!commit) return true;
      version = commit->map_version();
    }
    events.push_back({m.publish_time_ns, kind->second, version});
    return true;
  });
  if (!read) return read.error();
  std::ranges::stable_sort(events, {}, &Event::ns);
  return events;
}

}  // namespace

Result<ScanToCommit> scan_to_commit(recording::Reader& reader) {
  const auto events = events_of(reader);
  if (!events) return events.error();
  ScanToCommit result;
  std::optional<std::uint64_t> scan_ns;            // the newest
  std::map<std::uint64_t, std::uint64_t> scan_of;  // of a version of the map, not yet answered
  for (const Event& event : *events) {
    if (event.kind == Kind::scan) {
      scan_ns = event.ns;
    } else if (event.kind == Kind::update && scan_ns) {
      scan_of.clear();
      scan_of[event.version] = *scan_ns;
      ++result.scans;
    } else if (event.kind == Kind::commit) {
      ++result.commits;
      const auto scan = scan_of.find(event.version);
      if (scan == scan_of.end()) continue;
      result.latency_ms.push_back(double(event.ns - scan->second) * 1e-6);
      scan_of.clear();
    }
  }
  std::ranges::sort(result.latency_ms);
  if (!result.latency_ms.empty()) return result;
  return fail(ErrorCode::invalid_input,
              "no commit of the recording names a map version that a scan of it made");
}

ScanToCommit fly_live(const std::string& launch) {
  const fs::path goshawk = fs::path(this_program()).parent_path() / "../../bin/goshawk";
  const fs::path folder =
      fs::temp_directory_path() / ("goshawk-bench-replan-" + std::to_string(getpid()) + launch);
  fs::create_directories(folder);
  const auto domain = runtime::hold_private_domain();
  if (!domain) throw std::runtime_error(domain.error().message);
  {
    Child flight({goshawk.string(), "fly", "--live", "--launch", launch, "--output",
                  folder.string(), "--json"},
                 *domain);
    const auto end = std::chrono::steady_clock::now() + kFlight;
    while (!flight.ended() && std::chrono::steady_clock::now() < end) {
      std::this_thread::sleep_for(std::chrono::milliseconds(50));
    }
  }
  const auto flown = nlohmann::json::parse(std::ifstream(folder / "flight.json"), nullptr, false);
  if (!flown.is_object() || !flown.value("ok", false)) {
    throw std::runtime_error("a live flight with " + launch + " did not arrive: " +
                             (flown.is_object() ? flown.value("message", "") : "no flight.json") +
                             "; its folder is " + folder.string());
  }
  auto reader = recording::Reader::open((folder / "flight.mcap").string());
  if (!reader) throw std::runtime_error(reader.error().message);
  auto measured = scan_to_commit(*reader);
  if (!measured) throw std::runtime_error(measured.error().message);
  fs::remove_all(folder);
  return *std::move(measured);
}

}  // namespace goshawk::bench
