#include "goshawk/flight_report/page.hpp"

#include <fmt/format.h>

#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>

#include "file.hpp"

namespace goshawk::flight_report {
namespace {

// Numbers are written as float: seven digits are enough for a picture, and the page stays small.
using Json = nlohmann::basic_json<nlohmann::ordered_map, std::vector, std::string, bool,
                                  std::int64_t, std::uint64_t, float>;

constexpr double kLeastStep_s = 0.02;  // between samples of the track: a page need not weigh more
constexpr std::string_view kMark = "@FLIGHT@";

std::string base64(const std::string& bytes) {
  static constexpr char kDigits[] =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve(bytes.size() / 3 * 4 + 4);
  for (std::size_t k = 0; k < bytes.size(); k += 3) {
    std::uint32_t word = 0;
    const std::size_t count = std::min<std::size_t>(3, bytes.size() - k);
    for (std::size_t i = 0; i < 3; ++i) {
      word = word << 8 | (i < count ? static_cast<unsigned char>(bytes[k + i]) : 0U);
    }
    for (std::size_t i = 0; i < 4; ++i) {
      text += i <= count ? kDigits[word >> (18 - 6 * i) & 63] : '=';
    }
  }
  return text;
}

void append_leb128(std::string& bytes, std::uint64_t value) {
  for (; value > 127; value >>= 7) bytes += static_cast<char>((value & 127) | 128);
  bytes += static_cast<char>(value);
}

// Lengths of free and occupied runs in turn, x fastest, beginning with free: maps are mostly runs.
std::string runs_of(const BitGrid& grid) {
  std::string bytes;
  const Index3 size = grid.size();
  bool value = false;
  std::uint64_t length = 0;
  for (int z = 0; z < size.z; ++z) {
    for (int y = 0; y < size.y; ++y) {
      const BitGrid::Word* row = grid.row(y, z);
      for (int x = 0; x < size.x; ++x) {
        const bool bit = (row[x >> 6] >> (x & 63)) & 1U;
        if (bit != value) {
          append_leb128(bytes, length);
          length = 0;
          value = bit;
        }
        ++length;
      }
    }
  }
  append_leb128(bytes, length);
  return bytes;
}

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
          {"runs", base64(runs_of(grid->grown))}};
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

Json to_json(const Leg& leg) {
  Json corridor = Json::array(), pieces = Json::array();
  for (const Polytope& polytope : leg.corridor) corridor.push_back(to_json(polytope));
  for (const BezierPiece& piece : leg.trajectory.pieces) pieces.push_back(to_json(piece));
  return {{"start", leg.start_t_s},
          {"raw", to_json(leg.raw_path_map)},
          {"waypoints", to_json(leg.waypoints_map)},
          {"corridor", corridor},
          {"pieces", pieces}};
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
