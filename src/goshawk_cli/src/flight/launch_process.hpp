#pragma once

#include <sys/types.h>

#include <optional>
#include <string>

#include "cli.hpp"

namespace goshawk::cli {

/// The domain to work in: ROS_DOMAIN_ID where it is set, else one that no other Goshawk command on
/// this machine works in, held until this process ends.
Result<int> private_domain();

/// A `goshawk` verb as a child of this process, in a process group of its own.
class LaunchProcess {
 public:
  /// @param output_file where its own words go
  static Result<LaunchProcess> start_verb(const Arguments& verb, int domain,
                                          const std::string& output_file);
  /// `goshawk launch`, which stops when this process ends.
  static Result<LaunchProcess> start(const Arguments& launch_arguments, int domain,
                                     const std::string& output_file);
  LaunchProcess(LaunchProcess&& other) noexcept : pid_(std::exchange(other.pid_, -1)) {}
  LaunchProcess& operator=(LaunchProcess&&) = delete;
  ~LaunchProcess() { stop(); }

  pid_t pid() const { return pid_; }
  /// @return the exit status if it has ended by itself
  std::optional<int> ended();
  /// Asks it to stop, waits until it has; nothing where it has ended already.
  void stop();

 private:
  explicit LaunchProcess(pid_t pid) : pid_(pid) {}
  pid_t pid_;
};

}  // namespace goshawk::cli
