#pragma once

#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <string>
#include <vector>

namespace goshawk {

/// One goshawk_container, ended with the test.
class Stage {
 public:
  explicit Stage(std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), CONTAINER);
    std::vector<char*> argv;
    for (auto& argument : arguments) argv.push_back(argument.data());
    argv.push_back(nullptr);
    if (posix_spawn(&pid_, CONTAINER, nullptr, nullptr, argv.data(), environ) != 0) pid_ = -1;
  }
  ~Stage() {
    if (pid_ <= 0) return;
    kill(pid_, SIGTERM);
    waitpid(pid_, nullptr, 0);
  }
  Stage(const Stage&) = delete;
  Stage& operator=(const Stage&) = delete;

 private:
  pid_t pid_ = -1;
};

}  // namespace goshawk
