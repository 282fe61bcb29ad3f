#include "common/child.hpp"

#include <fcntl.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <cstring>
#include <filesystem>
#include <stdexcept>
#include <thread>

namespace goshawk::bench {
namespace {

constexpr int kGrace_ms = 3000;  // to end in peace

// This process' variables, with another domain.
std::vector<std::string> environment(int domain) {
  std::vector<std::string> variables{"ROS_DOMAIN_ID=" + std::to_string(domain)};
  for (char** v = environ; *v != nullptr; ++v) {
    if (std::strncmp(*v, "ROS_DOMAIN_ID=", 14) != 0) variables.emplace_back(*v);
  }
  return variables;
}

std::vector<char*> pointers(std::vector<std::string>& texts) {
  std::vector<char*> list;
  for (auto& text : texts) list.push_back(text.data());
  list.push_back(nullptr);
  return list;
}

}  // namespace

Child::Child(const std::vector<std::string>& words, int domain) {
  std::vector<std::string> arguments = words;
  std::vector<std::string> variables = environment(domain);
  const auto argv = pointers(arguments), envp = pointers(variables);
  pid_ = fork();
  if (pid_ == 0) {                     // only what is safe between fork and exec
    prctl(PR_SET_PDEATHSIG, SIGTERM);  // a bench that is killed leaves nothing behind
    const int null = open("/dev/null", O_WRONLY);
    dup2(null, STDOUT_FILENO);  // its standard output is not the report's
    execvpe(argv[0], argv.data(), envp.data());
    _exit(127);
  }
  if (pid_ < 0) {
    throw std::runtime_error("cannot start " + words[0] + ": " + std::strerror(errno));
  }
}

bool Child::ended() {
  if (!reaped_) reaped_ = waitpid(pid_, nullptr, WNOHANG) == pid_;
  return reaped_;
}

Child::~Child() {
  if (ended()) return;
  kill(pid_, SIGTERM);
  for (int waited_ms = 0; waited_ms < kGrace_ms; waited_ms += 10) {
    if (ended()) return;
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  kill(pid_, SIGKILL);
  waitpid(pid_, nullptr, 0);
}

std::string this_program() {
  return std::filesystem::read_symlink("/proc/self/exe");
}

}  // namespace goshawk::bench
