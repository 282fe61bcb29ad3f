#include "flight/flight_folder.hpp"

#include <fmt/format.h>

#include <fstream>

#include "flight/recorded_world.hpp"
#include "goshawk/flight_report/files.hpp"
#include "goshawk/flight_report/page.hpp"
#include "process.hpp"

namespace goshawk::cli {
namespace {

double seconds(std::int64_t ns, std::int64_t origin_ns) {
  return double(ns - origin_ns) * 1e-9;
}

flight_report::Leg make_leg(const CommittedTrajectory& committed, const FlightRecorder& record,
                            std::int64_t origin_ns) {
  auto leg = flight_report::Leg::of(committed, origin_ns);
  if (const auto r = record.requests().find(committed.id()); r != record.requests().end()) {
    leg.raw_path_map = conversions::from_msg(r->second.path.raw());
    leg.waypoints_map = conversions::from_msg(r->second.path.waypoints());
  }
  return leg;
}

}  // namespace

std::vector<flight_check::Sample> flown_track(const FlightRecorder& record) {
  std::vector<flight_check::Sample> track;
  for (const auto& [stamp_ns, state] : record.flown()) {
    track.push_back(
        {seconds(stamp_ns, record.flown().front().stamp_ns), state.position_map, state.q_map_base});
  }
  return track;
}

Status write_flight(const std::string& folder, const Json& summary, const FlightRecorder& record,
                    const std::vector<Vec3>& goals_map, const LoadedMap& map, double body_radius_m,
                    bool recorded, const std::function<void(const std::string&)>& say) {
  std::ofstream json(folder + "/flight.json");
  json << summary.dump(2, ' ', false, Json::error_handler_t::replace) << '\n';
  if (!json.flush()) {
    return fail(ErrorCode::io_failed,
                fmt::format("{}/flight.json cannot be written: is the disk full?", folder));
  }
  if (record.flown().empty()) return success();
  const VoxelGrid raw{.geometry = map.raw.geometry, .grown = map.raw.occupied, .known = {}};
  flight_report::Flight flight;
  flight.title = "Flight " + std::filesystem::path(folder).filename().string();
  flight.obstacles = &raw;
  flight.grown = map.grown.get();
  flight.body_radius_m = body_radius_m;
  flight.goals_map = goals_map;
  const std::int64_t origin_ns = record.flown().front().stamp_ns;
  for (const auto& committed : record.committed()) {
    flight.legs.push_back(make_leg(committed, record, origin_ns));
    flight.limits = committed.nominal().limits();
  }
  for (const auto& [stamp_ns, state] : record.flown()) {
    flight.flown.push_back(
        {seconds(stamp_ns, origin_ns), state.position_map, state.velocity_map, state.q_map_base});
  }
  if (recorded) {
    if (auto added = add_recorded_world(folder, origin_ns, flight); !added) {
      say(fmt::format("the page shows no growth of the map: {}", added.error().message));
    }
    if (auto drawn = draw_growth(flight, folder); !drawn) return drawn;
  }
  if (auto drawn = flight_report::write_flight_folder(flight, folder); !drawn) return drawn;
  return flight_report::write_flight_page(flight, page_template(), folder + "/flight.html",
                                          to_line(summary));
}

}  // namespace goshawk::cli
