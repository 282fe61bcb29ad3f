#pragma once

#include <cstdlib>
#include <filesystem>
#include <string>

namespace goshawk::cli {

/// Where this program is installed: the folder above its bin/.
inline std::string install_prefix() {
  return std::filesystem::read_symlink("/proc/self/exe").parent_path().parent_path().string();
}

/// The HTML page that flights are put into (goshawk_viewer).
inline std::string page_template() {
  return install_prefix() + "/share/goshawk/viewer/page.html";
}

/// A folder that goes away with this object.
class TemporaryFolder {
 public:
  TemporaryFolder() {
    std::string pattern = (std::filesystem::temp_directory_path() / "goshawk-XXXXXX").string();
    if (mkdtemp(pattern.data()) != nullptr) path_ = pattern;
  }
  ~TemporaryFolder() {
    std::error_code ignored;
    if (!path_.empty()) std::filesystem::remove_all(path_, ignored);
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  const std::string& path() const { return path_; }

 private:
  std::string path_;
};

}  // namespace goshawk::cli
