#pragma once

namespace goshawk::introspection {

/// From construction to destruction SIGINT and SIGTERM only set a flag, and a file that grows beyond
/// its limit is an error instead of a signal; at the end the handlers of before are back.
class Interruptible {
 public:
  Interruptible();
  ~Interruptible();
  Interruptible(const Interruptible&) = delete;
  Interruptible& operator=(const Interruptible&) = delete;
  static bool interrupted();
};

}  // namespace goshawk::introspection
