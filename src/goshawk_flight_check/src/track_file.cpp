#include "goshawk/flight_check/track_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <fstream>

#include "goshawk/flight_check/planned_track.hpp"

namespace goshawk::flight_check {
namespace {

using Row = std::vector<double>;

std::vector<std::string> split(std::string line) {
  if (line.ends_with('\r')) line.pop_back();
  std::vector<std::string> parts(1);
  for (const char c : line) {
    if (c == ',') {
      parts.emplace_back();
    } else {
      parts.back() += c;
    }
  }
  return parts;
}

Error wrong(const std::filesystem::path& file, const std::string& what) {
  return fail(ErrorCode::invalid_input, "'" + file.string() + "' " + what);
}

// Where each wanted column stands; the optional one last, if it is there.
Result<std::vector<std::size_t>> find_columns(const std::filesystem::path& file,
                                              const std::string& head,
                                              const std::vector<std::string>& wanted,
                                              const std::string& optional) {
  const auto names = split(head);
  std::vector<std::size_t> columns;
  for (const auto& name : wanted) {
    const auto at = std::ranges::find(names, name);
    if (at == names.end()) return wrong(file, "has no column " + name);
    columns.push_back(std::size_t(at - names.begin()));
  }
  const auto at = std::ranges::find(names, optional);
  if (at != names.end()) columns.push_back(std::size_t(at - names.begin()));
  return columns;
}

Result<std::vector<Row>> read_table(const std::filesystem::path& file,
                                    const std::vector<std::string>& wanted,
                                    const std::string& optional = "") {
  std::ifstream in(file);
  std::string line;
  if (!in || !std::getline(in, line)) {
    return fail(ErrorCode::io_failed, "'" + file.string() + "' cannot be read: is it there?");
  }
  const auto columns = find_columns(file, line, wanted, optional);
  if (!columns) return columns.error();
  std::vector<Row> rows;
  for (int number = 2; std::getline(in, line); ++number) {
    const auto parts = split(line);
    Row row;
    for (const std::size_t column : *columns) {
      double value = 0.0;
      const std::string part = column < parts.size() ? parts[column] : "";
      const auto [end, error] = std::from_chars(part.data(), part.data() + part.size(), value);
      if (error != std::errc{} || end != part.data() + part.size()) {
        return wrong(file, fmt::format("line {}: '{}' is not a number", number, part));
      }
      row.push_back(value);
    }
    rows.push_back(std::move(row));
  }
  return rows;
}

}  // namespace

Result<std::vector<Sample>> read_flown_csv(const std::filesystem::path& file) {
  const auto rows = read_table(file, {"t_s", "x_m", "y_m", "z_m", "qw", "qx", "qy", "qz"});
  if (!rows) return rows.error();
  std::vector<Sample> track;
  for (const auto& r : *rows) {
    track.push_back({r[0], {r[1], r[2], r[3]}, Quaternion(r[4], r[5], r[6], r[7])});
  }
  return track;
}

Result<std::vector<std::vector<Sample>>> read_planned_csv(const std::filesystem::path& file,
                                                          double yaw_rad) {
  const std::vector<std::string> wanted{"leg", "t_s",     "x_m",     "y_m",
                                        "z_m", "ax_m_s2", "ay_m_s2", "az_m_s2"};
  const auto rows = read_table(file, wanted, "yaw_rad");
  if (!rows) return rows.error();
  std::vector<std::vector<Sample>> legs;
  const double* leg = nullptr;
  for (const auto& r : *rows) {
    if (leg == nullptr || *leg != r[0]) legs.emplace_back();
    leg = r.data();
    const double yaw = r.size() > wanted.size() ? r.back() : yaw_rad;
    legs.back().push_back({r[1], {r[2], r[3], r[4]}, flat_attitude({r[5], r[6], r[7]}, yaw)});
  }
  return legs;
}

}  // namespace goshawk::flight_check
