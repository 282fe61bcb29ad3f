#include "goshawk/mission/mission_file.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "parsers.hpp"

namespace goshawk::mission {
namespace {

Error at(const std::string& path, const LineFault& fault) {
  const std::string where = fault.line > 0 ? fmt::format(", line {}", fault.line) : "";
  return fail(ErrorCode::invalid_input, fmt::format("{}{}: {}", path, where, fault.message));
}

// Each waypoint, then the mission as a whole.
std::optional<LineFault> fault_of(const MissionFile& file) {
  for (std::size_t i = 0; i < file.lines.size(); ++i) {
    if (auto status = check(file.mission.waypoints[i]); !status) {
      return LineFault{file.lines[i],
                       fmt::format("waypoint {}: {}", i + 1, status.error().message)};
    }
  }
  if (auto status = check(file.mission); !status) {
    return LineFault{file.lines.empty() ? 0 : file.lines.back(), status.error().message};
  }
  return {};
}

}  // namespace

Result<MissionFile> parse_mission(const std::string& path, const std::string& text) {
  const std::string ending = std::filesystem::path(path).extension();
  MissionFile file;
  file.mission.name = path;
  try {
    if (ending == ".yaml" || ending == ".yml") {
      parse_yaml(text, file);
    } else if (ending == ".csv") {
      parse_csv(text, file);
    } else {
      return fail(ErrorCode::invalid_input,
                  fmt::format("{}: a mission is a .yaml, .yml or .csv file", path));
    }
  } catch (const LineFault& fault) {
    return at(path, fault);
  }
  if (const auto fault = fault_of(file)) return at(path, *fault);
  return file;
}

Result<MissionFile> read_mission(const std::string& path) {
  std::ifstream stream(path, std::ios::binary);
  stream.peek();  // a folder can be opened, but not read
  if (!stream.is_open() || stream.bad()) {
    return fail(ErrorCode::io_failed,
                fmt::format("{} cannot be read: {}", path, std::strerror(errno)));
  }
  const std::string text(std::istreambuf_iterator<char>(stream), {});
  return parse_mission(path, text);
}

}  // namespace goshawk::mission
