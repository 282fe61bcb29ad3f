#pragma once

#include <sys/types.h>

#include <string>

#include "bench/plan_rig.hpp"

namespace goshawk::cli {

/// A PlanRig in a process of its own: DDS Security is a matter of a whole process, so that one
/// alone cannot ask stages with it and stages without it in turns.
class PlanChild {
 public:
  /// @pre this process has only one thread
  /// @return io_failed
  static Result<PlanChild> start(const PlanRigOptions& options);
  PlanChild(PlanChild&& other) noexcept;
  PlanChild& operator=(PlanChild&&) = delete;
  ~PlanChild();

  /// As PlanRig::start() in the child. Once, before the others.
  Status ready();
  Result<PlanSample> sample();
  Result<double> processor_s();

 private:
  PlanChild(pid_t pid, int socket) : pid_(pid), socket_(socket) {}
  /// Asks one question. @return its answer, or io_failed: the child has ended
  Result<std::string> ask(char question);
  Result<std::string> read_line();

  pid_t pid_;
  int socket_;
  std::string received_;
};

}  // namespace goshawk::cli
