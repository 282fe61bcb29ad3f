#include "search/warframe_files.hpp"

#include <cmath>
#include <fstream>
#include <sstream>

namespace worlds {

using goshawk::BitGrid;
using goshawk::ErrorCode;
using goshawk::Index3;
using goshawk::Result;

namespace {

goshawk::Error malformed(const std::string& path, int line, const std::string& what) {
  return goshawk::fail(ErrorCode::map_malformed,
                       path + ", line " + std::to_string(line) + ": " + what);
}

goshawk::Error unreadable(const std::string& path) {
  return goshawk::fail(ErrorCode::map_unreadable, path + " cannot be read: does it exist?");
}

}  // namespace

Result<BitGrid> read_voxel_map(const std::string& path) {
  std::ifstream in(path);
  if (!in) return unreadable(path);
  std::string word;
  Index3 size, at;
  if (!(in >> word >> size.x >> size.y >> size.z) || word != "voxel") {
    return malformed(path, 1, "it must be 'voxel X Y Z', the size");
  }
  if (auto status = BitGrid::check_size(size); !status) return status.error();
  BitGrid blocked(size, true);
  int line = 2;
  for (; in >> at.x >> at.y >> at.z; ++line) {
    if (!blocked.contains(at)) return malformed(path, line, "the voxel is outside the map");
    blocked.set(at, true);
  }
  if (!in.eof()) return malformed(path, line, "it must be 'x y z', an occupied voxel");
  return blocked;
}

Result<std::vector<Problem>> read_scenario(const std::string& path) {
  std::ifstream in(path);
  if (!in) return unreadable(path);
  std::vector<Problem> problems;
  std::string text;
  for (int line = 1; std::getline(in, text); ++line) {
    if (line <= 2 || text.find_first_not_of(" \t\r") == std::string::npos) continue;
    Problem p;
    std::istringstream words(text);
    if (!(words >> p.start.x >> p.start.y >> p.start.z >> p.goal.x >> p.goal.y >> p.goal.z >>
          p.length_voxels) ||
        !std::isfinite(p.length_voxels)) {
      return malformed(path, line, "it must be start, goal and length: seven numbers or more");
    }
    problems.push_back(p);
  }
  if (problems.empty()) return malformed(path, 3, "there is no problem in the file");
  return problems;
}

}  // namespace worlds
