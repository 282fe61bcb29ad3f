// The public Warframe problems (Brewer and Sturtevant, SoCS 2018) give optimal lengths under the
// no-squeeze rule, found by other people's code.
#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <sstream>

#include "goshawk/path_search/planner.hpp"

namespace goshawk::path_search {
namespace {

std::string folder() {
  const char* data = std::getenv("GOSHAWK_DATA");
  if (data != nullptr) return std::string(data) + "/warframe/";
  // From the test's working directory up to the project, whose sibling `shared` holds the data.
  for (std::string up = "../"; up.size() < 30; up += "../") {
    if (std::ifstream(up + "shared/data/warframe/Simple.3dmap"))
      return up + "shared/data/warframe/";
  }
  return "";
}

bool load(const std::string& path, BitGrid& map) {
  std::ifstream in(path);
  std::string word;
  Index3 at;
  if (!(in >> word >> at.x >> at.y >> at.z)) return false;
  map = BitGrid(at, true);
  while (in >> at.x >> at.y >> at.z) map.set(at, true);
  return true;
}

void match_published_lengths(const std::string& name, int every, Planner choice) {
  BitGrid map;
  const std::string path = folder() + name;
  if (!load(path, map)) {
    GTEST_SKIP() << path << " is not there: set GOSHAWK_DATA to the data folder";
  }
  std::ifstream problems(path + ".3dscen");
  ASSERT_TRUE(problems) << "the map is there, its problems are not";
  Config config;
  config.planner = choice;
  const auto planner = std::move(make_planner(config)).value();
  planner->set_map(map);
  std::string line;
  int matched = 0;
  for (int n = -2; std::getline(problems, line); ++n) {
    if (n < 0 || n % every != 0) continue;
    std::istringstream in(line);
    Index3 s, g;
    double length = 0.0;
    ASSERT_TRUE(in >> s.x >> s.y >> s.z >> g.x >> g.y >> g.z >> length) << line;
    const auto found = planner->search(s, g);
    ASSERT_TRUE(found.ok()) << line << ": " << found.error().message;
    ASSERT_NEAR(found->cost_voxels, length, 1e-7 + 1e-8 * length) << line;  // eight decimals
    ++matched;
  }
  EXPECT_GT(matched, 100);
}

TEST(Warframe, JaStarMatchesEveryPublishedLengthOfSimple) {
  match_published_lengths("Simple.3dmap", 1, Planner::jastar);
}
TEST(Warframe, JaStarMatchesEveryPublishedLengthOfComplex) {
  match_published_lengths("Complex.3dmap", 1, Planner::jastar);
}
TEST(Warframe, AStarMatchesThePublishedLengthsOfComplex) {
  match_published_lengths("Complex.3dmap", 10, Planner::astar);
}

}  // namespace
}  // namespace goshawk::path_search
