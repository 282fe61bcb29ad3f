#include "flight/launch_process.hpp"

#include <fcntl.h>
#include <signal.h>
#include <spawn.h>
#include <sys/file.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstring>
#include <filesystem>

#include "folders.hpp"
#include "goshawk/runtime/context.hpp"

namespace goshawk::cli {
namespace {

int exit_status(int status) {
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128;
}

// This process' environment with the domain set.
std::vector<std::string> environment(int domain) {
  std::vector<std::string> variables;
  for (char** at = environ; *at != nullptr; ++at) {
    if (std::strncmp(*at, "ROS_DOMAIN_ID=", 14) != 0) variables.emplace_back(*at);
  }
  variables.push_back("ROS_DOMAIN_ID=" + std::to_string(domain));
  return variables;
}

std::vector<char*> pointers_to(std::vector<std::string>& words) {
  std::vector<char*> pointers;
  for (auto& word : words) pointers.push_back(word.data());
  pointers.push_back(nullptr);
  return pointers;
}

// Below the kernel's ephemeral ports (32768 and up), above the domains that people choose.
constexpr int kFirstPrivateDomain = 20;
constexpr int kPrivateDomains = 80;

// Takes the lock of a domain; the kernel gives it back when this process ends, however it does.
bool hold_domain(int domain) {
  const auto name = "goshawk-domain-" + std::to_string(domain) + ".lock";
  const auto file = std::filesystem::temp_directory_path() / name;
  const int descriptor = open(file.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
  if (descriptor < 0) return false;
  if (flock(descriptor, LOCK_EX | LOCK_NB) == 0) return true;
  close(descriptor);
  return false;
}

}  // namespace

Result<int> private_domain() {
  const auto options = runtime::ContextOptions::from_environment();
  if (!options) return options.error();
  const char* set = std::getenv("ROS_DOMAIN_ID");
  if (set != nullptr && *set != '\0') return options->domain;
  for (int i = 0; i < kPrivateDomains; ++i) {
    const int domain = kFirstPrivateDomain + (int(getpid()) + i) % kPrivateDomains;
    if (hold_domain(domain)) return domain;
  }
  return fail(ErrorCode::io_failed,
              "all private domains are in use: stop other flights, or set ROS_DOMAIN_ID");
}

Result<LaunchProcess> LaunchProcess::start(const Arguments& launch_arguments, int domain,
                                           const std::string& output_file) {
  Arguments verb{"launch", "--stop-with-parent", "--parent", std::to_string(getpid())};
  verb.insert(verb.end(), launch_arguments.begin(), launch_arguments.end());
  return start_verb(verb, domain, output_file);
}

Result<LaunchProcess> LaunchProcess::start_verb(const Arguments& verb, int domain,
                                                const std::string& output_file) {
  Arguments command{install_prefix() + "/bin/goshawk"};
  command.insert(command.end(), verb.begin(), verb.end());
  auto variables = environment(domain);
  auto argv = pointers_to(command);
  auto envp = pointers_to(variables);

  posix_spawn_file_actions_t files;
  posix_spawn_file_actions_init(&files);
  posix_spawn_file_actions_addopen(&files, 0, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_addopen(&files, 1, output_file.c_str(), O_WRONLY | O_CREAT | O_TRUNC,
                                   0644);
  posix_spawn_file_actions_adddup2(&files, 1, 2);
  posix_spawnattr_t attributes;
  posix_spawnattr_init(&attributes);
  // Ctrl-C reaches this process alone, which then stops the flight in order.
  posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP | POSIX_SPAWN_SETSIGMASK);
  sigset_t none;
  sigemptyset(&none);
  posix_spawnattr_setsigmask(&attributes, &none);
  pid_t pid = -1;
  const int error = posix_spawn(&pid, argv[0], &files, &attributes, argv.data(), envp.data());
  posix_spawn_file_actions_destroy(&files);
  posix_spawnattr_destroy(&attributes);
  if (error != 0) {
    return fail(ErrorCode::io_failed, command[0] + " cannot be started: " + std::strerror(error));
  }
  return LaunchProcess(pid);
}

std::optional<int> LaunchProcess::ended() {
  int status = 0;
  if (pid_ < 0 || waitpid(pid_, &status, WNOHANG) != pid_) return {};
  pid_ = -1;
  return exit_status(status);
}

void LaunchProcess::stop() {
  if (pid_ < 0) return;
  kill(pid_, SIGINT);
  int status = 0;
  waitpid(pid_, &status, 0);
  pid_ = -1;
}

}  // namespace goshawk::cli
