#pragma once

#include <sys/types.h>

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "goshawk/core/result.hpp"

namespace goshawk::cli {

/// The domain to work in: ROS_DOMAIN_ID if it is set, otherwise one that no other Goshawk command
/// on this machine works in, held until this process ends.
Result<int> private_domain();

/// A `goshawk` verb as a child of this process, in a process group of its own. It stops when this
/// process ends.
class ChildVerb {
 public:
  /// @param verb with its arguments; it must know --stop-with-parent
  /// @param output_file where its own words go
  static Result<ChildVerb> start(const std::vector<std::string>& verb, int domain,
                                 const std::string& output_file);
  ChildVerb(ChildVerb&& other) noexcept
      : pid_(std::exchange(other.pid_, -1)), output_file_(std::move(other.output_file_)) {}
  ChildVerb& operator=(ChildVerb&&) = delete;
  ~ChildVerb() { stop(); }

  pid_t pid() const { return pid_; }
  /// @return the exit status if it has ended by itself
  std::optional<int> ended();
  /// What it said when it ended by itself: its failure, or stage_silent if it left none.
  Error failure() const;
  /// Asks it to stop and waits until it has.
  void stop();

 private:
  ChildVerb(pid_t pid, std::string output_file) : pid_(pid), output_file_(std::move(output_file)) {}
  pid_t pid_;
  std::string output_file_;
};

/// `goshawk launch` of these arguments, with --json.
Result<ChildVerb> start_launch(const std::vector<std::string>& arguments, int domain,
                               const std::string& output_file);

}  // namespace goshawk::cli
