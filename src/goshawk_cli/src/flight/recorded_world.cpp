#include "flight/recorded_world.hpp"

#include <algorithm>
#include <filesystem>

#include "flight/why_json.hpp"
#include "goshawk/flight_report/growth.hpp"
#include "goshawk/viewer/recorded_flight.hpp"
#include "goshawk/why_messages/snapshot_collector.hpp"

namespace goshawk::cli {
namespace {

constexpr std::size_t kPanels = 4;
// By so much a recorder may be behind. Stages that have ended meanwhile do not count as silent yet.
constexpr std::int64_t kRecorderLag_ns = 1'000'000'000;
static_assert(double(kRecorderLag_ns) * 1e-9 < why::kSilent_s - 0.2);

Result<recording::Reader> open_recording(const std::string& folder) {
  return recording::Reader::open(folder + "/flight.mcap");
}

}  // namespace

Status add_recorded_world(const std::string& folder, std::int64_t origin_ns,
                          flight_report::Flight& flight) {
  auto reader = open_recording(folder);
  if (!reader) return reader.error();
  const auto recorded = viewer::RecordedFlight::read(*reader);
  if (!recorded) return recorded.error();
  recorded->add_world(flight, origin_ns);
  return success();
}

Json recorded_reason(const std::string& folder, std::int64_t at_ns) {
  auto reader = open_recording(folder);
  if (!reader) return nullptr;
  at_ns += kRecorderLag_ns;
  why::SnapshotCollector collector;
  if (!collector.read(*reader, "/", std::uint64_t(at_ns))) return nullptr;
  return to_json(why::explain(collector.snapshot(at_ns)));
}

Status draw_growth(const flight_report::Flight& flight, const std::string& folder) {
  auto moments = flight_report::spread(flight.maps, kPanels);
  if (moments.size() < 2) return success();
  for (auto& moment : moments) {
    for (const auto& sample : flight.flown) {
      if (sample.t_s <= moment.t_s) moment.track_map.push_back(sample.position_map);
    }
    moment.t_s =
        std::max(0.0, moment.t_s);  // the map may be a little older than the first odometry
  }
  return flight_report::draw_growth(moments, folder + "/growth.png");
}

}  // namespace goshawk::cli
