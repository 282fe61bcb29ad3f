#include "flight/child_verb.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstring>
#include <fstream>
#include <nlohmann/json.hpp>

#include "goshawk/runtime/context.hpp"
#include "goshawk/runtime/private_domain.hpp"
#include "process.hpp"

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
  variables.push_back(fmt::format("ROS_DOMAIN_ID={}", domain));
  return variables;
}

ErrorCode code_of(const std::string& name) {
  for (const ErrorCode code : all_error_codes()) {
    if (to_string(code) == name) return code;
  }
  return ErrorCode::stage_silent;
}

std::vector<char*> pointers_to(std::vector<std::string>& words) {
  std::vector<char*> pointers;
  for (auto& word : words) pointers.push_back(word.data());
  pointers.push_back(nullptr);
  return pointers;
}

}  // namespace

Result<int> private_domain() {
  const auto options = runtime::ContextOptions::from_environment();
  if (!options) return options.error();
  const char* set = std::getenv("ROS_DOMAIN_ID");
  if (set != nullptr && *set != '\0') return options->domain;
  return runtime::hold_private_domain();
}

Result<ChildVerb> ChildVerb::start(const std::vector<std::string>& verb, int domain,
                                   const std::string& output_file) {
  std::vector<std::string> command{install_prefix() + "/bin/goshawk", verb.front(),
                                   "--stop-with-parent", "--parent", std::to_string(getpid())};
  command.insert(command.end(), verb.begin() + 1, verb.end());
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
    return fail(ErrorCode::io_failed,
                fmt::format("{} cannot be started: {}", command[0], std::strerror(error)));
  }
  return ChildVerb(pid, output_file);
}

std::optional<int> ChildVerb::ended() {
  int status = 0;
  if (pid_ < 0 || waitpid(pid_, &status, WNOHANG) != pid_) return {};
  pid_ = -1;
  return exit_status(status);
}

Error ChildVerb::failure() const {
  Error error =
      fail(ErrorCode::stage_silent, fmt::format("it ended without a reason: see {}", output_file_));
  std::ifstream file(output_file_);
  for (std::string line; std::getline(file, line);) {
    const auto object = nlohmann::json::parse(line, nullptr, false);
    if (!object.is_object() || object.value("ok", true)) continue;
    error = fail(code_of(object.value("code", "")), object.value("message", ""));
  }
  return error;
}

void ChildVerb::stop() {
  if (pid_ < 0) return;
  kill(pid_, SIGINT);
  int status = 0;
  waitpid(pid_, &status, 0);
  pid_ = -1;
}

Result<ChildVerb> start_launch(const std::vector<std::string>& arguments, int domain,
                               const std::string& output_file) {
  std::vector<std::string> verb{"launch", "--json"};
  verb.insert(verb.end(), arguments.begin(), arguments.end());
  return ChildVerb::start(verb, domain, output_file);
}

}  // namespace goshawk::cli
