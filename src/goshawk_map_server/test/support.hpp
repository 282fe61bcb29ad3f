#pragma once

#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

#include "goshawk/core/grid_geometry.hpp"
#include "goshawk/core/random.hpp"
#include "goshawk/map_server/voxel_map.hpp"

namespace goshawk::map_server::testing {

/// A folder of its own that goes away with the test.
class Folder {
 public:
  Folder() {
    static int number = 0;
    path_ = std::filesystem::temp_directory_path() /
            ("goshawk_map_" + std::to_string(::getpid()) + "_" + std::to_string(number++));
    std::filesystem::create_directories(path_);
  }
  ~Folder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;

  std::string file(const std::string& name) const { return (path_ / name).string(); }
  std::string write(const std::string& name, const std::string& bytes) const {
    std::ofstream(file(name), std::ios::binary) << bytes;
    return file(name);
  }

 private:
  std::filesystem::path path_;
};

inline std::string bytes_of(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::ostringstream all;
  all << file.rdbuf();
  return all.str();
}

/// The shared real maps; see the data folder's README.
inline std::string data(const std::string& name) {
  const char* folder = std::getenv("GOSHAWK_DATA");
  for (const std::string& root :
       {std::string(folder != nullptr ? folder : ""), std::string("../shared/data"),
        std::string(GOSHAWK_SOURCE_ROOT) + "/../shared/data"}) {
    if (!root.empty() && std::filesystem::exists(root + "/" + name)) return root + "/" + name;
  }
  return {};
}

#define GOSHAWK_NEED_DATA(variable, name)                                  \
  const std::string variable = ::goshawk::map_server::testing::data(name); \
  if (variable.empty())                                                    \
  GTEST_SKIP() << "the shared map " << (name)                              \
               << " is not here: set "                                     \
                  "GOSHAWK_DATA to the folder that holds it"

inline bool is_occupied(const RawVoxels& voxels, const Vec3& p_map) {
  const auto voxel = voxels.geometry.index_of(p_map);
  return voxel && voxels.occupied.get(*voxel);
}

inline BitGrid random_bits(Index3 size, bool outside, double share, Random& random) {
  BitGrid bits(size, outside);
  for (int z = 0; z < size.z; ++z) {
    for (int y = 0; y < size.y; ++y) {
      for (int x = 0; x < size.x; ++x) bits.set({x, y, z}, random.chance(share));
    }
  }
  return bits;
}

/// Blocks of equal bits, so that a tree has leaves of all sizes.
inline BitGrid random_blocks(Index3 size, bool outside, int blocks, Random& random) {
  BitGrid bits(size, outside);
  for (int i = 0; i < blocks; ++i) {
    const Index3 lo{random.below(size.x), random.below(size.y), random.below(size.z)};
    const int x1 = std::min(size.x, lo.x + 1 + random.below(20));
    const bool value = random.chance(0.7);
    for (int z = lo.z; z < std::min(size.z, lo.z + 1 + random.below(20)); ++z) {
      for (int y = lo.y; y < std::min(size.y, lo.y + 12); ++y) bits.set_run(lo.x, x1, y, z, value);
    }
  }
  return bits;
}

}  // namespace goshawk::map_server::testing
