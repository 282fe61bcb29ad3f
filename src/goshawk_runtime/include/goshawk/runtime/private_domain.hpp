#pragma once

#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <algorithm>
#include <cstddef>
#include <stdexcept>
#include <string>

namespace goshawk::runtime {

/// A DDS domain from 101 to 232 for a test or a measurement: none of those that run at the same
/// time on this machine has it. Given back when the process ends, however it does.
/// @throws std::runtime_error where all are held
inline int hold_private_domain() {
  constexpr int kFirst = 101, kMany = 132;
  for (int k = 0; k < kMany; ++k) {
    const int domain = kFirst + (int(getpid()) * 7 + k) % kMany;
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
  throw std::runtime_error("no DDS domain from 101 to 232 is free");
}

}  // namespace goshawk::runtime
