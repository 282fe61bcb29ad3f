#pragma once

namespace goshawk::introspection {

/// From construction to destruction SIGINT and SIGTERM only set a flag, and a file that grows
/// beyond its limit is an error instead of a signal; the destructor restores the previous handlers.
class Interruptible {
 public:
  Interruptible();
  ~Interruptible();
  Interruptible(const Interruptible&) = delete;
  Interruptible& operator=(const Interruptible&) = delete;
  static bool interrupted();
};

}  // namespace goshawk::introspection
