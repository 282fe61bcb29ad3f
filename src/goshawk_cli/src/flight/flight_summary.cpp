#include "flight/flight_summary.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace goshawk::cli {
namespace {

constexpr StageRole kStages[] = {StageRole::path_search, StageRole::corridor_builder,
                                 StageRole::trajectory_optimizer, StageRole::navigator,
                                 StageRole::tracker};

Json stages_json(const RequestRecord& record) {
  Json stages = Json::array();
  for (const StageRole stage : kStages) {
    const auto found = record.reports.find(stage);
    if (found == record.reports.end()) continue;
    const auto& report = found->second;
    Json counters = Json::object();
    for (const auto& counter : report.counters())
      counters[counter.name()] = to_json(counter.value());
    stages.push_back({{"name", to_string(stage)},
                      {"implementation", report.implementation()},
                      {"code", report.code()},
                      {"compute_us", double(report.compute_ns()) * 1e-3},
                      {"wire_us", double(report.wire_ns()) * 1e-3},
                      {"counters", counters}});
  }
  return stages;
}

double length_of(const std::vector<Vec3>& points_map) {
  double length_m = 0.0;
  for (std::size_t i = 1; i < points_map.size(); ++i) {
    length_m += (points_map[i] - points_map[i - 1]).norm();
  }
  return length_m;
}

// Lengths are those of the points: a search stage of another make may leave the fields for them
// zero, and its raw path empty.
Json path_json(const RequestRecord& record) {
  const auto raw_map = conversions::from_msg(record.path.raw());
  const auto waypoints_map = conversions::from_msg(record.path.waypoints());
  if (waypoints_map.empty()) return nullptr;
  return {{"raw_length_m", raw_map.empty() ? Json(nullptr) : Json(length_of(raw_map))},
          {"pruned_length_m", length_of(waypoints_map)},
          {"waypoints_raw", raw_map.size()},
          {"waypoints", waypoints_map.size()},
          {"expanded", record.path.expanded()},
          {"points", to_json(waypoints_map)},
          {"raw_points", to_json(raw_map)}};
}

Json corridor_json(const RequestRecord& record) {
  if (record.corridor.polytopes().empty()) return nullptr;
  return {{"polytopes", record.corridor.polytopes().size()},
          {"min_overlap_radius_m", to_json(record.corridor.min_overlap_radius())}};
}

Json trajectory_json(const CommittedTrajectory* committed) {
  if (committed == nullptr) return nullptr;
  const auto& t = committed->flown();
  const auto peaks = t.peaks();
  return {{"duration_s", t.duration_s()},
          {"length_m", t.length_m()},
          {"mean_speed_m_s", t.length_m() / t.duration_s()},
          {"max_speed_m_s", peaks.speed_m_s},
          {"max_acceleration_m_s2", peaks.acceleration_m_s2},
          {"pieces", t.pieces.size()}};
}

/// @param commits of these only; nullptr: of all
Json tracking_json(const FlightRecorder& record, const std::vector<std::uint64_t>* commits) {
  double squares = 0.0;
  double largest = 0.0;
  std::size_t count = 0;
  for (const auto& e : record.errors()) {
    if (commits != nullptr && std::ranges::find(*commits, e.request_id) == commits->end()) continue;
    squares += e.position_error_m * e.position_error_m;
    largest = std::max(largest, e.position_error_m);
    ++count;
  }
  if (count == 0) return nullptr;
  return {{"rms_error_m", std::sqrt(squares / double(count))},
          {"max_error_m", largest},
          {"samples", count}};
}

const CommittedTrajectory* committed_of(const FlightRecorder& record, std::uint64_t id) {
  const auto found = std::ranges::find(record.committed(), id, &CommittedTrajectory::id);
  return found == record.committed().end() ? nullptr : &*found;
}

Json leg_json(const LegOutcome& leg, const FlightRecorder& record) {
  Json object{{"goal", to_json(leg.goal_map)},
              {"arrived", leg.arrived},
              {"code", leg.code},
              {"message", leg.message},
              {"flight_time_s", leg.flight_time_s},
              {"request_id", leg.request_id},
              {"commits", leg.commits.size()}};
  const auto request = record.requests().find(leg.request_id);
  const RequestRecord none;
  const RequestRecord& r = request == record.requests().end() ? none : request->second;
  object["stages"] = stages_json(r);
  object["path"] = path_json(r);
  object["corridor"] = corridor_json(r);
  object["trajectory"] = trajectory_json(committed_of(record, leg.request_id));
  object["tracking"] = tracking_json(record, &leg.commits);
  return object;
}

double number(const Json& object, const char* key) {
  return object.contains(key) && object[key].is_number() ? object[key].get<double>() : NAN;
}

std::string text(const Json& object, const char* key) {
  return object[key].get<std::string>();
}

void print_leg(const Json& leg, std::size_t index, std::size_t count) {
  const auto& g = leg["goal"];
  fmt::print(
      "\nleg {} of {} to ({:g}, {:g}, {:g}): {}\n", index, count, g[0].get<double>(),
      g[1].get<double>(), g[2].get<double>(),
      leg["arrived"].get<bool>() ? "arrived" : text(leg, "code") + ": " + text(leg, "message"));
  const auto commits = leg["commits"].get<std::size_t>();
  if (commits > 1)
    fmt::print("  {} trajectories were committed on the way; of the last:\n", commits);
  for (const auto& stage : leg["stages"]) {
    fmt::print("  {:<21} {:<20} compute {:8.1f} us   wire {:8.1f} us\n", text(stage, "name"),
               text(stage, "implementation"), number(stage, "compute_us"),
               number(stage, "wire_us"));
  }
  if (const auto& p = leg["path"]; !p.is_null()) {
    const double raw_m = number(p, "raw_length_m");
    fmt::print("  path       {}pruned {:.3f} m, {} waypoints\n",
               std::isnan(raw_m) ? std::string()
                                 : fmt::format("{:.3f} m, {} waypoints; ", raw_m,
                                               p["waypoints_raw"].get<std::int64_t>()),
               number(p, "pruned_length_m"), p["waypoints"].get<std::int64_t>());
  }
  if (const auto& c = leg["corridor"]; !c.is_null()) {
    fmt::print("  corridor   {} polytopes\n", c["polytopes"].get<std::int64_t>());
  }
  if (const auto& t = leg["trajectory"]; !t.is_null()) {
    fmt::print(
        "  trajectory {:.3f} m in {:.3f} s, mean {:.3f} m/s, top {:.3f} m/s and {:.3f} m/s^2\n",
        number(t, "length_m"), number(t, "duration_s"), number(t, "mean_speed_m_s"),
        number(t, "max_speed_m_s"), number(t, "max_acceleration_m_s2"));
  }
  if (const auto& t = leg["tracking"]; !t.is_null()) {
    fmt::print("  tracking   rms {:.1f} mm, largest {:.1f} mm{}\n", 1e3 * number(t, "rms_error_m"),
               1e3 * number(t, "max_error_m"), commits > 1 ? ", of all" : "");
  }
}

}  // namespace

bool FlightOutcome::all_arrived() const {
  return !legs.empty() && std::ranges::all_of(legs, &LegOutcome::arrived);
}

Json summary_json(const FlightOutcome& outcome, const FlightRecorder& record,
                  const std::string& folder) {
  Json legs = Json::array();
  for (const auto& leg : outcome.legs) legs.push_back(leg_json(leg, record));
  Json clearance = nullptr;
  if (outcome.verdict) {
    const auto& v = *outcome.verdict;
    clearance = {{"smallest_m", to_json(v.clearance_m)},
                 {"at_s", to_json(v.clearance_t_s)},
                 {"place", to_json(v.clearance_place_map)},
                 {"samples", v.samples},
                 {"sentence", v.sentence}};
  }
  // The first leg that failed speaks for the flight.
  std::string code = "ok";
  std::string message;
  for (const auto& leg : outcome.legs) {
    if (leg.arrived || code != "ok") continue;
    code = leg.code;
    message = leg.message;
  }
  if (code == "ok" && !outcome.verdict) {
    code = to_string(outcome.verdict.code());
    message = outcome.verdict.error().message;
  }
  const char* verdict = outcome.touched() ? "touched" : outcome.all_arrived() ? "safe" : "failed";
  if (!outcome.verdict) verdict = "not judged";
  return {{"ok", outcome.ok()},     {"code", code},    {"message", message},
          {"verdict", verdict},     {"legs", legs},    {"tracking", tracking_json(record, nullptr)},
          {"clearance", clearance}, {"folder", folder}};
}

void print_summary(const Json& summary) {
  const auto& legs = summary["legs"];
  for (std::size_t i = 0; i < legs.size(); ++i) print_leg(legs[i], i + 1, legs.size());
  fmt::print("\n");
  if (const auto& c = summary["clearance"]; !c.is_null()) {
    fmt::print("second opinion: {}\n", text(c, "sentence"));
  }
  fmt::print("verdict: {}{}{}\n", text(summary, "verdict"),
             summary["code"] == "ok" ? "" : ", " + text(summary, "code"),
             summary["message"] == "" ? "" : ": " + text(summary, "message"));
  if (const auto& why = summary["why"]; !why.is_null()) {
    fmt::print("why: {} {}\n", text(why, "because"), text(why, "mend"));
  }
  const auto folder = text(summary, "folder");
  fmt::print("flight folder: {}\nlook at it:    {}/flight.html (opens by double click)\n", folder,
             folder);
}

}  // namespace goshawk::cli
