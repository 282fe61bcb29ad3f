// Any bytes as any format of map: a sound map, or an error with a code of its own and a sentence.
// The first byte chooses the format.
#include <cstdint>
#include <cstdlib>
#include <string>

#include "goshawk/map_server/map_file.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace goshawk::map_server;
  static const char* const kNames[] = {"m.bt",  "m.ot",  "m.pcd", "m.ply",
                                       "m.3dmap", "m.stl", "m.obj"};
  if (size == 0) return 0;
  LoadOptions options;
  options.max_voxels = 1'000'000;
  options.cloud = CloudMeaning(data[0] / 8 % 3);
  options.drop_outliers = data[0] / 8 / 3 % 2 == 1;
  const auto source = load_map_bytes({reinterpret_cast<const char*>(data + 1), size - 1},
                                     kNames[data[0] % 8 % 7], options);
  // Clouds and voxel maps come as bits, trees and scans as a tree: always one of the two.
  if (source ? (source->tree != nullptr) == source->voxels.has_value()
             : source.error().message.empty()) {
    std::abort();
  }
  return 0;
}
