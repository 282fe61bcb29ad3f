#include "folder.hpp"

#include <fmt/format.h>
#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <filesystem>

namespace goshawk::recording {
namespace {

namespace fs = std::filesystem;

Error unfit(std::string sentence) {
  return fail(ErrorCode::invalid_input, std::move(sentence));
}

// The files that rosbag2's metadata.yaml lists. @return none without such a file; invalid_input if
// it is damaged
Result<std::vector<std::string>> listed_files(const fs::path& metadata) {
  std::error_code ignored;
  if (!fs::exists(metadata, ignored)) return std::vector<std::string>();
  try {
    const YAML::Node root = YAML::LoadFile(metadata.string());
    const YAML::Node bag = root["rosbag2_bagfile_information"];
    if (!bag) return std::vector<std::string>();  // of another program
    return bag["relative_file_paths"].as<std::vector<std::string>>();
  } catch (const YAML::Exception& fault) {
    return unfit(fmt::format("{} does not list the bag's files in relative_file_paths: {}",
                             metadata.string(), fault.what()));
  }
}

std::vector<std::string> names_in(const fs::path& folder, const std::string& ending) {
  std::vector<std::string> names;
  std::error_code ignored;
  for (const auto& entry : fs::directory_iterator(folder, ignored)) {
    const std::string name = entry.path().filename().string();
    if (name.ends_with(ending)) names.push_back(name);
  }
  std::ranges::sort(names);
  return names;
}

Status check_format(const fs::path& folder, const std::string& name) {
  if (name.ends_with(".mcap")) return success();
  if (name.ends_with(".db3")) {
    return unfit(
        fmt::format("{} is a bag in SQLite ({}): convert it to MCAP with 'ros2 bag "
                    "convert'",
                    folder.string(), name));
  }
  return unfit(
      fmt::format("{} is a bag of files like {}, which cannot be read: convert it to MCAP "
                  "without compression of whole files, with 'ros2 bag convert'",
                  folder.string(), name));
}

Result<Files> files_of_bag(const fs::path& folder, const std::vector<std::string>& names) {
  Files files;
  for (const std::string& name : names) {
    if (auto status = check_format(folder, name); !status) return status.error();
    // Old bags list names with their folder in front.
    const fs::path path = folder / fs::path(name).filename();
    std::error_code ignored;
    if (fs::exists(path, ignored)) {
      files.paths.push_back(path.string());
    } else {
      files.complaints.push_back(
          fmt::format("metadata.yaml lists {}, which is missing: its messages are left out", name));
    }
  }
  if (files.paths.empty()) {
    return unfit(
        fmt::format("{} holds none of the files that its metadata.yaml lists", folder.string()));
  }
  return files;
}

}  // namespace

Result<Files> recording_files(const std::string& path) {
  std::error_code ignored;
  if (!fs::is_directory(path, ignored)) return Files{{path}, {}};
  const fs::path folder(path);
  const auto listed = listed_files(folder / "metadata.yaml");
  if (!listed) return listed.error();
  if (!listed->empty()) return files_of_bag(folder, *listed);
  const auto found = names_in(folder, ".mcap");
  if (found.size() == 1) return Files{{(folder / found[0]).string()}, {}};
  if (found.empty()) {
    if (const auto bags = names_in(folder, ".db3"); !bags.empty()) {
      return check_format(folder, bags[0]).error();
    }
    return unfit(fmt::format("{} is a folder without a recording (.mcap)", path));
  }
  return unfit(
      fmt::format("{} holds {} recordings, and no metadata.yaml says that they belong "
                  "together: name one of them, such as {}",
                  path, found.size(), found[0]));
}

}  // namespace goshawk::recording
