#include "folder.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <fstream>

namespace goshawk::recording {
namespace {

namespace fs = std::filesystem;

Error unfit(std::string sentence) {
  return fail(ErrorCode::invalid_input, std::move(sentence));
}

std::string trimmed(std::string text) {
  constexpr const char* kAround = " \t\r'\"";
  text.erase(0, std::min(text.find_first_not_of(kAround), text.size()));
  text.erase(text.find_last_not_of(kAround) + 1);
  return text;
}

// The list `relative_file_paths` of rosbag2's metadata.yaml, as rosbag2 writes it: a name a line.
std::vector<std::string> listed_files(const fs::path& metadata) {
  std::vector<std::string> names;
  std::ifstream file(metadata);
  bool inside = false;
  for (std::string line; std::getline(file, line);) {
    const std::string text = trimmed(line);
    if (inside && !text.starts_with("- ")) break;
    if (inside) names.push_back(trimmed(text.substr(2)));
    inside = inside || text == "relative_file_paths:";
  }
  return names;
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
  if (const auto listed = listed_files(folder / "metadata.yaml"); !listed.empty()) {
    return files_of_bag(folder, listed);
  }
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
