#include "goshawk/flight_report/page.hpp"

#include <fmt/format.h>

#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>

#include "file.hpp"
#include "map_growth.hpp"
#include "runs.hpp"

namespace goshawk::flight_report {
namespace {

// Numbers are written as float: seven digits are enough for a picture, and the page stays small.
using Json = nlohmann::basic_json<nlohmann::ordered_map, std::vector, std::string, bool,
                                  std::int64_t, std::uint64_t, float>;

constexpr double kLeastStep_s = 0.02;  // between samples of the track: a page need not weigh more
constexpr std::string_view kMark = "@FLIGHT@";

Json to_json(const Vec3& v) {
  return {v.x(), v.y(), v.z()};
}

Json to_json(const std::vector<Vec3>& points) {
  Json list = Json::array();
  for (const Vec3& p : points) list.push_back(to_json(p));
  return list;
}

Json to_json(const VoxelGrid* grid) {
  if (grid == nullptr) return nullptr;
  const auto& g = grid->geometry;
  return {{"origin", to_json(g.origin_map)},
          {"resolution", g.resolution_m},
          {"size", {g.size.x, g.size.y, g.size.z}},
          {"runs", runs_of(grid->grown)}};
}

Json to_json(const Polytope& polytope) {
  Json normals = Json::array(), offsets = Json::array();
  for (const HalfSpace& face : polytope.half_spaces) {
    for (int axis = 0; axis < 3; ++axis) normals.push_back(face.normal[axis]);
    offsets.push_back(face.offset_m);
  }
  return {{"A", normals}, {"b", offsets}};
}

Json to_json(const BezierPiece& piece) {
  Json points = Json::array();
  for (int k = 0; k < piece.control_points.cols(); ++k) {
    points.push_back(to_json(Vec3(piece.control_points.col(k))));
  }
  return {{"duration", piece.duration_s}, {"points", points}};
}

Json to_json(const std::vector<BezierPiece>& pieces) {
  Json list = Json::array();
  for (const BezierPiece& piece : pieces) list.push_back(to_json(piece));
  return list;
}

Json to_json(const Leg& leg) {
  Json corridor = Json::array();
  for (const Polytope& polytope : leg.corridor) corridor.push_back(to_json(polytope));
  return {{"start", leg.start_t_s},
          {"raw", to_json(leg.raw_path_map)},
          {"waypoints", to_json(leg.waypoints_map)},
          {"corridor", corridor},
          {"pieces", to_json(leg.trajectory.pieces)},
          {"stop_after", leg.stop_after_s},
          {"nominal", to_json(leg.nominal.pieces)}};
}

/// Each moment as what changed since the one before.
Json growth_json(const std::vector<MapMoment>& maps) {
  const MapGrowth growth = growth_of(maps);
  if (growth.changes.size() < 2) return nullptr;  // it did not grow
  Json moments = Json::array();
  for (const auto& change : growth.changes) {
    const Index3 at = change.window, size = change.window_size;
    moments.push_back({{"t", change.t_s},
                       {"window", {at.x, at.y, at.z, size.x, size.y, size.z}},
                       {"obstacles", change.obstacles},
                       {"known", change.known}});
  }
  const auto& g = growth.geometry;
  return {{"origin", to_json(g.origin_map)},
          {"resolution", g.resolution_m},
          {"size", {g.size.x, g.size.y, g.size.z}},
          {"moments", moments}};
}

Json to_json(const Quaternion& q) {
  return {q.w(), q.x(), q.y(), q.z()};
}

Json to_json(const MovingBox& box) {
  return {{"id", box.id},
          {"kind", box.kind},
          {"p", to_json(box.position_map)},
          {"q", to_json(box.q_map_box)},
          {"half", to_json(box.half_m)}};
}

Json to_json(const PredictedBox& box) {
  Json track = Json::array();
  for (const auto& piece : box.track) {
    track.push_back(
        {{"duration", piece.duration_s}, {"points", to_json(piece.control_points_map)}});
  }
  return {{"id", box.id},
          {"q", to_json(box.q_map_box)},
          {"half", to_json(box.half_extents_m)},
          {"track", track},
          {"error", box.error_m},
          {"error_rate", box.error_rate_m_s},
          {"valid_until", box.valid_until_s}};
}

/// @param moments of moving boxes or of predictions
template <typename Moments>
Json boxes_json(const Moments& moments) {
  Json list = Json::array();
  for (const auto& moment : moments) {
    Json boxes = Json::array();
    for (const auto& box : moment.boxes) boxes.push_back(to_json(box));
    list.push_back({{"t", moment.t_s}, {"boxes", boxes}});
  }
  return list;
}

std::vector<FlownSample> thinned(const std::vector<FlownSample>& flown) {
  std::vector<FlownSample> kept;
  for (const auto& sample : flown) {
    const bool last = &sample == &flown.back();
    if (kept.empty() || last || sample.t_s - kept.back().t_s >= kLeastStep_s)
      kept.push_back(sample);
  }
  return kept;
}

/// Columns of numbers, one after another: what the page reads fastest.
Json to_json(const std::vector<FlownSample>& flown) {
  Json t = Json::array(), p = Json::array(), v = Json::array(), q = Json::array();
  const auto append = [](Json& column, const Vec3& vector) {
    for (int axis = 0; axis < 3; ++axis) column.push_back(vector[axis]);
  };
  for (const FlownSample& s : thinned(flown)) {
    t.push_back(s.t_s);
    append(p, s.position_map);
    append(v, s.velocity_map);
    q.push_back(s.q_map_base.w());
    append(q, s.q_map_base.vec());
  }
  return {{"t", t}, {"p", p}, {"v", v}, {"q", q}};
}

Result<std::string> flight_json(const Flight& flight, const std::string& summary_json) {
  const Json summary = Json::parse(summary_json, nullptr, false);
  if (summary.is_discarded()) {
    return fail(ErrorCode::invalid_input, "the flight's summary is not JSON");
  }
  Json legs = Json::array();
  for (const Leg& leg : flight.legs) legs.push_back(to_json(leg));
  const Json json{
      {"title", flight.title},
      {"body_radius", flight.body_radius_m},
      {"limits", {{"v_max", flight.limits.v_max_m_s}, {"a_max", flight.limits.a_max_m_s2}}},
      {"legs", legs},
      {"stops", to_json(flight.stops_map())},
      {"flown", to_json(flight.flown)},
      {"obstacles", to_json(flight.obstacles)},
      {"grown", to_json(flight.grown)},
      {"growth", growth_json(flight.maps)},
      {"movers", boxes_json(flight.movers)},
      {"predictions", boxes_json(flight.predictions)},
      {"summary", summary}};
  // "<" could end the script element that the JSON stands in.
  std::string text;
  for (const char c : json.dump(-1, ' ', false, Json::error_handler_t::replace)) {
    if (c == '<') {
      text += "\\u003c";
    } else {
      text += c;
    }
  }
  return text;
}

}  // namespace

Status write_flight_page(const Flight& flight, const std::filesystem::path& page_template,
                         const std::filesystem::path& file, const std::string& summary_json) {
  if (auto status = flight.check(); !status) return status;
  std::ifstream in(page_template, std::ios::binary);
  const std::string page{std::istreambuf_iterator<char>(in), {}};
  const std::size_t mark = page.find(kMark);
  if (!in || mark == std::string::npos) {
    return fail(ErrorCode::io_failed,
                fmt::format("'{}' is not a page template: is goshawk_viewer installed?",
                            page_template.string()));
  }
  const auto json = flight_json(flight, summary_json);
  if (!json) return json.error();
  return write_file(file, page.substr(0, mark) + *json + page.substr(mark + kMark.size()));
}

}  // namespace goshawk::flight_report
