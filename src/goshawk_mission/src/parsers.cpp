#include "parsers.hpp"

#include <fmt/format.h>
#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <numbers>
#include <sstream>
#include <vector>

#include "goshawk/core/number.hpp"

namespace goshawk::mission {
namespace {

constexpr std::array kFields{
    Field{"yaw_deg", [](Waypoint& w, double v) { w.yaw_rad = v * std::numbers::pi / 180.0; }},
    Field{"hold_s", [](Waypoint& w, double v) { w.hold_s = v; }},
    Field{"v_max_m_s", [](Waypoint& w, double v) { w.v_max_m_s = v; }},
    Field{"pass_within_m", [](Waypoint& w, double v) { w.pass_radius_m = v; }}};
constexpr std::array<std::string_view, 3> kAxes{"x_m", "y_m", "z_m"};

int line_of(const YAML::Node& node) {
  return node.Mark().line + 1;
}

double yaml_number(const YAML::Node& node, std::string_view what) {
  if (!node.IsScalar()) {
    throw LineFault{line_of(node), fmt::format("{} is not a number", what)};
  }
  return number_of(node.Scalar(), what, line_of(node));
}

Vec3 position_of(const YAML::Node& node) {
  if (!node.IsSequence() || node.size() != 3) {
    throw LineFault{line_of(node), "position is not three numbers in metres: write [3, 8, 2]"};
  }
  Vec3 position_map;
  for (int axis = 0; axis < 3; ++axis) {
    position_map[axis] = yaml_number(node[std::size_t(axis)], "position");
  }
  return position_map;
}

Waypoint waypoint_of(const YAML::Node& node) {
  if (!node.IsMap()) {
    throw LineFault{line_of(node), "a waypoint is not a map of keys: write - position: [3, 8, 2]"};
  }
  Waypoint waypoint;
  std::vector<std::string> seen;
  for (const auto& entry : node) {
    const std::string key = entry.first.IsScalar() ? entry.first.Scalar() : "";
    if (std::ranges::find(seen, key) != seen.end()) {
      throw LineFault{line_of(entry.first), fmt::format("{} is specified twice", key)};
    }
    seen.push_back(key);
    if (key == "position") {
      waypoint.position_map = position_of(entry.second);
    } else if (const Field* field = find_field(key)) {
      field->set(waypoint, yaml_number(entry.second, key));
    } else {
      throw LineFault{
          line_of(entry.first),
          fmt::format("a waypoint has no key '{}': it has position, {}", key, field_names())};
    }
  }
  if (std::ranges::find(seen, "position") == seen.end()) {
    throw LineFault{line_of(node), "the waypoint has no position: write position: [3, 8, 2]"};
  }
  return waypoint;
}

void add_yaml(const YAML::Node& root, MissionFile& file) {
  if (!root.IsMap()) {
    throw LineFault{1, "it is not a map of keys: write waypoints: and below it a list"};
  }
  for (const auto& entry : root) {
    const std::string key = entry.first.IsScalar() ? entry.first.Scalar() : "";
    if (key == "name" && entry.second.IsScalar()) {
      file.mission.name = entry.second.Scalar();
    } else if (key == "waypoints" && entry.second.IsSequence()) {
      for (const auto& node : entry.second) {
        file.mission.waypoints.push_back(waypoint_of(node));
        file.lines.push_back(line_of(node));
      }
    } else if (key == "name" || key == "waypoints") {
      throw LineFault{line_of(entry.first),
                      key == "name" ? "name is not a text" : "waypoints is not a list"};
    } else {
      throw LineFault{line_of(entry.first),
                      fmt::format("a mission has no key '{}': it has name, waypoints", key)};
    }
  }
}

std::string trimmed(std::string_view text) {
  const auto first = text.find_first_not_of(" \t\r");
  if (first == std::string_view::npos) return {};
  return std::string(text.substr(first, text.find_last_not_of(" \t\r") - first + 1));
}

std::vector<std::string> cells_of(const std::string& line) {
  std::vector<std::string> cells;
  std::size_t begin = 0;
  for (std::size_t end = 0; end != std::string::npos; begin = end + 1) {
    end = line.find(',', begin);
    cells.push_back(trimmed(
        std::string_view(line).substr(begin, end == std::string::npos ? end : end - begin)));
  }
  return cells;
}

void check_columns(const std::vector<std::string>& columns, int line) {
  for (const std::string& name : columns) {
    if (find_field(name) == nullptr && std::ranges::find(kAxes, name) == kAxes.end()) {
      throw LineFault{line, fmt::format("there is no column '{}': the first line names x_m, y_m, "
                                        "z_m and any of {}",
                                        name, field_names())};
    }
    if (std::ranges::count(columns, name) > 1) {
      throw LineFault{line, fmt::format("column {} is specified twice", name)};
    }
  }
  for (const std::string_view axis : kAxes) {
    if (std::ranges::find(columns, axis) != columns.end()) continue;
    throw LineFault{line, fmt::format("column {} is missing", axis)};
  }
}

Waypoint waypoint_of(const std::vector<std::string>& columns, const std::vector<std::string>& cells,
                     int line) {
  if (cells.size() != columns.size()) {
    throw LineFault{line, fmt::format("it has {} values, but there are {} columns", cells.size(),
                                      columns.size())};
  }
  Waypoint waypoint;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const auto axis = std::ranges::find(kAxes, columns[i]);
    if (axis != kAxes.end()) {
      waypoint.position_map[axis - kAxes.begin()] = number_of(cells[i], columns[i], line);
    } else if (!cells[i].empty()) {
      find_field(columns[i])->set(waypoint, number_of(cells[i], columns[i], line));
    }
  }
  return waypoint;
}

}  // namespace

const Field* find_field(std::string_view name) {
  const auto at = std::ranges::find(kFields, name, &Field::name);
  return at == kFields.end() ? nullptr : &*at;
}

std::string field_names() {
  std::string names;
  for (const Field& field : kFields) names += (names.empty() ? "" : ", ") + std::string(field.name);
  return names;
}

double number_of(const std::string& text, std::string_view what, int line) {
  const auto value = finite_number(text);
  if (!value) {
    throw LineFault{line, text.empty() ? fmt::format("{} is empty", what)
                                       : fmt::format("{}: '{}' is not a number", what, text)};
  }
  return *value;
}

void parse_yaml(const std::string& text, MissionFile& file) {
  try {
    add_yaml(YAML::Load(text), file);
  } catch (const YAML::Exception& fault) {
    throw LineFault{fault.mark.line + 1, "it is not valid YAML: " + fault.msg};
  }
}

void parse_csv(const std::string& text, MissionFile& file) {
  std::istringstream stream(text);
  std::vector<std::string> columns;
  std::string line;
  for (int number = 1; std::getline(stream, line); ++number) {
    const std::string content = trimmed(line.substr(0, line.find('#')));
    if (content.empty()) continue;
    const auto cells = cells_of(content);
    if (columns.empty()) {
      check_columns(cells, number);
      columns = cells;
      continue;
    }
    file.mission.waypoints.push_back(waypoint_of(columns, cells, number));
    file.lines.push_back(number);
  }
}

}  // namespace goshawk::mission
