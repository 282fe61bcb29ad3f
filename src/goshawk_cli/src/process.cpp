#include "process.hpp"

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <signal.h>
#include <sys/prctl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>

namespace goshawk::cli {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kLogFoldersKept = 50;

fs::path state_home() {
  const auto set = [](const char* name) {
    const char* value = std::getenv(name);
    return value != nullptr && *value != '\0' ? value : nullptr;
  };
  if (const char* state = set("XDG_STATE_HOME")) return state;
  if (const char* home = set("HOME")) return fs::path(home) / ".local/state";
  return fs::temp_directory_path() / fmt::format("goshawk-{}", geteuid());
}

// Their names begin with their date, so that the oldest come first.
void remove_oldest(const fs::path& logs) {
  std::vector<fs::path> folders;
  std::error_code ignored;
  for (const auto& entry : fs::directory_iterator(logs, ignored)) folders.push_back(entry.path());
  std::ranges::sort(folders);
  for (std::size_t i = 0; i + kLogFoldersKept < folders.size(); ++i) {
    fs::remove_all(folders[i], ignored);
  }
}

}  // namespace

std::string install_prefix() {
  return fs::read_symlink("/proc/self/exe").parent_path().parent_path().string();
}

std::string page_template() {
  return install_prefix() + "/share/goshawk/viewer/page.html";
}

int become(const std::vector<std::string>& command, const Console& console) {
  std::vector<char*> pointers;
  for (const auto& word : command) pointers.push_back(const_cast<char*>(word.c_str()));
  pointers.push_back(nullptr);
  execv(pointers[0], pointers.data());
  return console.not_done({ErrorCode::io_failed, fmt::format("{} cannot be started: {}", command[0],
                                                             std::strerror(errno))});
}

int become_helper(const std::string& name, Json options, const Console& console) {
  options["json"] = console.json();
  options["prefix"] = install_prefix();
  std::vector<std::string> command{install_prefix() + "/lib/goshawk/" + name, to_line(options)};
  if (name.ends_with(".py")) command.insert(command.begin(), "/usr/bin/python3");
  return become(command, console);
}

void stop_with_parent(int parent) {
  prctl(PR_SET_PDEATHSIG, SIGINT);
  if (parent != 0 && getppid() != parent) raise(SIGINT);
}

Result<std::string> make_log_folder(const std::string& what) {
  const fs::path logs = state_home() / "goshawk/log";
  const fs::path folder = logs / fmt::format("{:%Y-%m-%d_%H-%M-%S}_{}_{}",
                                             fmt::localtime(std::time(nullptr)), getpid(), what);
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) {
    return fail(ErrorCode::io_failed, fmt::format("the folder for logs {} cannot be made: {}; set "
                                                  "XDG_STATE_HOME to a folder that you may write to",
                                                  folder.string(), error.message()));
  }
  remove_oldest(logs);
  return folder.string();
}

}  // namespace goshawk::cli
