#pragma once

#include <fcntl.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <string>
#include <vector>

#include "goshawk/runtime/private_domain.hpp"

namespace cli_test {

using Steady = std::chrono::steady_clock;

inline int domain() {
  static const int held = goshawk::runtime::hold_private_domain().value();
  return held;
}

struct Outcome {
  int status = -1;  // exit status; -signal if one ended it
  std::string out;
  std::string err;
};

inline double seconds_since(Steady::time_point begin) {
  return std::chrono::duration<double>(Steady::now() - begin).count();
}

/// A child whose output is collected; ends it after `most_s`, so that no test hangs.
class Child {
 public:
  explicit Child(std::vector<std::string> arguments, int in_domain = domain(),
                 const std::string& input = "") {
    setenv("ROS_DOMAIN_ID", std::to_string(in_domain).c_str(), 1);
    arguments.insert(arguments.begin(), GOSHAWK_PROGRAM);
    std::vector<char*> argv;
    for (auto& argument : arguments) argv.push_back(argument.data());
    argv.push_back(nullptr);
    int in[2], out[2], err[2];
    EXPECT_EQ(pipe2(in, O_CLOEXEC), 0);
    EXPECT_EQ(write(in[1], input.data(), input.size()), ssize_t(input.size()));  // a pipe holds it
    close(in[1]);
    EXPECT_EQ(pipe2(out, O_CLOEXEC), 0);
    EXPECT_EQ(pipe2(err, O_CLOEXEC), 0);
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_adddup2(&actions, in[0], 0);
    posix_spawn_file_actions_adddup2(&actions, out[1], 1);
    posix_spawn_file_actions_adddup2(&actions, err[1], 2);
    EXPECT_EQ(posix_spawn(&pid_, GOSHAWK_PROGRAM, &actions, nullptr, argv.data(), environ), 0);
    posix_spawn_file_actions_destroy(&actions);
    close(in[0]);
    close(out[1]);
    close(err[1]);
    out_ = out[0];
    err_ = err[0];
  }
  ~Child() {
    close(out_);
    close(err_);
  }

  /// Collects until something came on standard output, or the child ended.
  void wait_for_output(double most_s = 60.0) {
    const auto begin = Steady::now();
    while (outcome_.out.empty() && open_ > 0 && seconds_since(begin) < most_s) collect(0.1);
  }
  void interrupt() { kill(pid_, SIGINT); }
  Outcome finish(double most_s = 60.0) {
    const auto begin = Steady::now();
    while (open_ > 0 && seconds_since(begin) < most_s) collect(0.1);
    if (open_ > 0) {
      ADD_FAILURE() << "still running after " << most_s << " s";
      kill(pid_, SIGKILL);
    }
    int status = 0;
    waitpid(pid_, &status, 0);
    outcome_.status = WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
    return outcome_;
  }

 private:
  void collect(double timeout_s) {
    pollfd fds[2] = {{out_, POLLIN, 0}, {err_, POLLIN, 0}};
    if (poll(fds, 2, int(timeout_s * 1000)) <= 0) return;
    for (int i = 0; i < 2; ++i) {
      if (fds[i].revents == 0) continue;
      char buffer[4096];
      const auto n = read(fds[i].fd, buffer, sizeof buffer);
      int& fd = i == 0 ? out_ : err_;
      if (n > 0) {
        (i == 0 ? outcome_.out : outcome_.err).append(buffer, std::size_t(n));
      } else {
        close(fd);
        fd = -1;
        --open_;
      }
    }
  }

  pid_t pid_ = 0;
  int out_ = -1;
  int err_ = -1;
  int open_ = 2;
  Outcome outcome_;
};

inline Outcome run(std::vector<std::string> arguments, int in_domain = domain()) {
  return Child(std::move(arguments), in_domain).finish();
}

/// Of what is there, however long a busy machine takes to find it: it waits no longer than it must.
inline Outcome find(std::vector<std::string> arguments) {
  arguments.insert(arguments.end(), {"--timeout", "30"});
  return run(std::move(arguments));
}

}  // namespace cli_test
