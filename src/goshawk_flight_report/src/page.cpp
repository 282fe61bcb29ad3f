#include "goshawk/flight_report/page.hpp"

#include <charconv>
#include <fstream>
#include <iterator>

#include "file.hpp"

namespace goshawk::flight_report {
namespace {

constexpr double kLeastStep_s = 0.02;  // between samples of the track: a page need not weigh more
constexpr std::string_view kMark = "@FLIGHT@";

void append(std::string& text, double value) {
  char digits[32];
  const auto end =
      std::to_chars(digits, digits + sizeof digits, value, std::chars_format::general, 7).ptr;
  text.append(digits, end);
}

void append(std::string& text, const Vec3& v) {
  for (int axis = 0; axis < 3; ++axis) {
    if (axis > 0) text += ',';
    append(text, v[axis]);
  }
}

// "<" would let a title end the script element that the JSON stands in.
std::string quoted(const std::string& raw) {
  std::string text = "\"";
  for (const char c : raw) {
    if (c == '"' || c == '\\') text += '\\';
    if (c == '<') {
      text += "\\u003c";
    } else {
      text += static_cast<unsigned char>(c) < 0x20 ? ' ' : c;
    }
  }
  return text + '"';
}

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

void append_grid(std::string& text, const char* name, const VoxelGrid* grid) {
  text += std::string(",\"") + name + "\":";
  if (grid == nullptr) {
    text += "null";
    return;
  }
  const auto& g = grid->geometry;
  text += "{\"origin\":[";
  append(text, g.origin_map);
  text += "],\"resolution\":";
  append(text, g.resolution_m);
  text += ",\"size\":[" + std::to_string(g.size.x) + ',' + std::to_string(g.size.y) + ',' +
          std::to_string(g.size.z) + "],\"runs\":\"" + base64(runs_of(grid->occupied)) + "\"}";
}

/// Comma-separated elements of a JSON array.
template <typename Range, typename Write>
void append_list(std::string& text, const Range& range, Write&& write) {
  text += '[';
  bool first = true;
  for (const auto& element : range) {
    if (!first) text += ',';
    first = false;
    write(element);
  }
  text += ']';
}

void append_points(std::string& text, const std::vector<Vec3>& points) {
  append_list(text, points, [&](const Vec3& p) {
    text += '[';
    append(text, p);
    text += ']';
  });
}

void append_polytope(std::string& text, const Polytope& polytope) {
  text += "{\"A\":[";
  for (int i = 0; i < polytope.faces(); ++i) {
    if (i > 0) text += ',';
    append(text, polytope.half_spaces[std::size_t(i)].normal);
  }
  text += "],\"b\":[";
  for (int i = 0; i < polytope.faces(); ++i) {
    if (i > 0) text += ',';
    append(text, polytope.half_spaces[std::size_t(i)].offset_m);
  }
  text += "]}";
}

void append_piece(std::string& text, const BezierPiece& piece) {
  text += "{\"duration\":";
  append(text, piece.duration_s);
  text += ",\"points\":";
  std::vector<Vec3> points;
  for (int k = 0; k < piece.control_points.cols(); ++k)
    points.push_back(piece.control_points.col(k));
  append_points(text, points);
  text += '}';
}

void append_leg(std::string& text, const Leg& leg) {
  text += "{\"start\":";
  append(text, leg.start_t_s);
  text += ",\"raw\":";
  append_points(text, leg.raw_path_map);
  text += ",\"waypoints\":";
  append_points(text, leg.waypoints_map);
  text += ",\"corridor\":";
  append_list(text, leg.corridor, [&](const Polytope& p) { append_polytope(text, p); });
  text += ",\"pieces\":";
  append_list(text, leg.trajectory.pieces, [&](const BezierPiece& p) { append_piece(text, p); });
  text += '}';
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

void append_flown(std::string& text, const std::vector<FlownSample>& flown) {
  const auto samples = thinned(flown);
  text += ",\"flown\":{\"t\":";
  append_list(text, samples, [&](const FlownSample& s) { append(text, s.t_s); });
  text += ",\"p\":";
  append_list(text, samples, [&](const FlownSample& s) { append(text, s.position_map); });
  text += ",\"v\":";
  append_list(text, samples, [&](const FlownSample& s) { append(text, s.velocity_map); });
  text += ",\"q\":";
  append_list(text, samples, [&](const FlownSample& s) {
    append(text, s.q_map_base.w());
    text += ',';
    append(text, Vec3(s.q_map_base.vec()));
  });
  text += '}';
}

std::string flight_json(const Flight& flight, const std::string& summary_json) {
  std::string text = "{\"title\":" + quoted(flight.title) + ",\"body_radius\":";
  append(text, flight.body_radius_m);
  text += ",\"limits\":{\"v_max\":";
  append(text, flight.limits.v_max_m_s);
  text += ",\"a_max\":";
  append(text, flight.limits.a_max_m_s2);
  text += "},\"legs\":";
  append_list(text, flight.legs, [&](const Leg& leg) { append_leg(text, leg); });
  append_flown(text, flight.flown);
  append_grid(text, "obstacles", flight.obstacles);
  append_grid(text, "grown", flight.grown);
  text += ",\"summary\":";
  for (const char c : summary_json) text += c == '<' ? std::string("\\u003c") : std::string(1, c);
  return text + '}';
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
                page_template.string() + " is no page template: is goshawk_viewer installed?");
  }
  return write_file(file, page.substr(0, mark) + flight_json(flight, summary_json) +
                              page.substr(mark + kMark.size()));
}

}  // namespace goshawk::flight_report
