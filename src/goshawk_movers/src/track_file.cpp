#include "track_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <fstream>

#include "yaml_keys.hpp"

namespace goshawk::movers {
namespace {

constexpr std::array<std::string_view, 5> kColumns{"t_s", "x_m", "y_m", "z_m", "yaw_rad"};
constexpr std::size_t kNeeded = 4;

std::vector<std::string> cells_of(std::string line) {
  std::vector<std::string> cells(1);
  for (const char c : line) {
    if (c == ',') {
      cells.emplace_back();
    } else if (c != ' ' && c != '\t' && c != '\r') {
      cells.back() += c;
    }
  }
  return cells;
}

// Where each column of kColumns stands; cells.size() for yaw_rad if it is not there.
std::array<std::size_t, kColumns.size()> find_columns(const std::vector<std::string>& cells) {
  std::array<std::size_t, kColumns.size()> columns{};
  for (std::size_t i = 0; i < kColumns.size(); ++i) {
    columns[i] = std::size_t(std::ranges::find(cells, kColumns[i]) - cells.begin());
    if (columns[i] == cells.size() && i < kNeeded) {
      throw LineFault{1, fmt::format("column {} is missing", kColumns[i])};
    }
  }
  return columns;
}

Place place_of(const std::vector<std::string>& cells,
               const std::array<std::size_t, kColumns.size()>& columns, std::size_t width,
               int line) {
  if (cells.size() != width) {
    throw LineFault{line,
                    fmt::format("it has {} values, but there are {} columns", cells.size(), width)};
  }
  std::array<double, kColumns.size()> values{};
  for (std::size_t i = 0; i < kColumns.size(); ++i) {
    if (columns[i] < width) values[i] = number_of(cells[columns[i]], kColumns[i], line);
  }
  return {values[0], Vec3(values[1], values[2], values[3]), values[4]};
}

}  // namespace

Result<std::vector<Place>> read_track(const std::filesystem::path& file) {
  std::ifstream in(file);
  std::string line;
  if (!in || !std::getline(in, line)) {
    return fail(ErrorCode::io_failed, fmt::format("{} cannot be read, or is empty", file.string()));
  }
  std::vector<Place> places;
  try {
    const auto head = cells_of(line);
    const auto columns = find_columns(head);
    for (int number = 2; std::getline(in, line); ++number) {
      if (line.find_first_not_of(" \t\r") == std::string::npos) continue;
      places.push_back(place_of(cells_of(line), columns, head.size(), number));
    }
  } catch (const LineFault& fault) {
    return fail(ErrorCode::invalid_input,
                fmt::format("{}, line {}: {}", file.string(), fault.line, fault.message));
  }
  return places;
}

}  // namespace goshawk::movers
