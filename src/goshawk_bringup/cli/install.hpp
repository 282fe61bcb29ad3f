#pragma once

#include <filesystem>
#include <string>

namespace goshawk::cli {

/// Where this program is installed: the folder above its bin/.
inline std::string install_prefix() {
  return std::filesystem::read_symlink("/proc/self/exe").parent_path().parent_path().string();
}

}  // namespace goshawk::cli
