#pragma once

#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <algorithm>
#include <cstddef>
#include <stdexcept>
#include <string>

namespace goshawk::runtime {

/// A DDS domain of `many` from `first` on that no other process on this machine holds; for a test or
/// a measurement, unless said otherwise. Given back when this process ends, however it ends.
/// @throws std::runtime_error if all are held
inline int hold_private_domain(int first = 101, int many = 132) {
  for (int k = 0; k < many; ++k) {
    const int domain = first + (int(getpid()) * 7 + k) % many;
    // A name that lives with its socket; the system tests hold theirs in the same way.
    const std::string name = "goshawk-test-domain-" + std::to_string(domain);
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    std::ranges::copy(name, address.sun_path + 1);  // a leading zero: of no folder
    const auto size = socklen_t(offsetof(sockaddr_un, sun_path) + 1 + name.size());
    const int held = socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0);
    if (bind(held, reinterpret_cast<const sockaddr*>(&address), size) == 0) return domain;
    close(held);
  }
  throw std::runtime_error("no DDS domain from " + std::to_string(first) + " to " +
                           std::to_string(first + many - 1) + " is free");
}

}  // namespace goshawk::runtime
