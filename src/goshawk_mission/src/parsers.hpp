#pragma once

#include <array>
#include <string>
#include <string_view>

#include "goshawk/mission/mission_file.hpp"

namespace goshawk::mission {

/// What is wrong with a text. Thrown by the parsers, which read forward; no caller of the library
/// sees it.
struct LineFault {
  int line = 0;  // from 1; 0: the text as a whole
  std::string message;
};

/// Both add waypoints and their lines. @throws LineFault
void parse_yaml(const std::string& text, MissionFile& file);
void parse_csv(const std::string& text, MissionFile& file);

/// The numbers of a waypoint besides its position: keys of a YAML map, columns of a table.
struct Field {
  std::string_view name;
  void (*set)(Waypoint&, double value);
};
const Field* find_field(std::string_view name);
/// "yaw_deg, hold_s, ..."
std::string field_names();
/// @throws LineFault unless it is one finite number
double number_of(const std::string& text, std::string_view what, int line);

}  // namespace goshawk::mission
