#pragma once

#include <sys/types.h>

#include <string>
#include <vector>

namespace goshawk::bench {

/// A program of this bench's own, stopped by its id with this object.
class Child {
 public:
  /// @param words program and arguments; @param domain its ROS_DOMAIN_ID
  /// @throws std::runtime_error if it cannot be started
  Child(const std::vector<std::string>& words, int domain);
  ~Child();
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;

  /// @return whether it has ended by itself
  bool ended();

 private:
  pid_t pid_ = -1;
  bool reaped_ = false;
};

/// The program that runs.
std::string this_program();

}  // namespace goshawk::bench
