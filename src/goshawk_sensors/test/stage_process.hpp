#pragma once

#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <string>
#include <thread>
#include <vector>

namespace goshawk::sensors {

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

  /// Waits for its end. @return its exit status; -1 if it does not end by itself in time
  int status(double most_s) {
    const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(most_s);
    int status = 0;
    while (waitpid(pid_, &status, WNOHANG) == 0) {
      if (std::chrono::steady_clock::now() > end) return -1;
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    pid_ = -1;
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }

 private:
  pid_t pid_ = -1;
};

}  // namespace goshawk::sensors
