#include "goshawk/runtime/private_domain.hpp"

#include <arpa/inet.h>
#include <fmt/format.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <algorithm>
#include <cstddef>

namespace goshawk::runtime {
namespace {

// Above the domains that people choose; the ports of 101 and up are the kernel's own (32768 ...).
constexpr int kFirst = 20;
constexpr int kMany = 80;
// Where DDS puts the discovery of a domain's first participant (RTPS 9.6.1.1).
constexpr int kFirstPort = 7400 + 10;
constexpr int kPortsOfDomain = 250;

// Binds a name in the abstract namespace, which lives as long as its socket: a process that is
// killed leaves nothing behind. tools/hold_domain.py uses the same names.
bool hold_name(int domain) {
  const std::string name = fmt::format("goshawk-domain-{}", domain);
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  std::ranges::copy(name, address.sun_path + 1);  // the leading zero makes it abstract
  const auto size = socklen_t(offsetof(sockaddr_un, sun_path) + 1 + name.size());
  const int held = socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0);
  if (held < 0) return false;
  if (bind(held, reinterpret_cast<const sockaddr*>(&address), size) == 0) return true;
  close(held);
  return false;
}

// A participant that does not hold its domain, of any DDS, has this port.
bool is_empty(int domain) {
  const int probe = socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  if (probe < 0) return false;
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(std::uint16_t(kFirstPort + kPortsOfDomain * domain));
  const bool bound = bind(probe, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0;
  close(probe);
  return bound;
}

}  // namespace

bool hold_domain(int domain) {
  return is_empty(domain) && hold_name(domain);
}

Result<int> hold_private_domain() {
  for (int k = 0; k < kMany; ++k) {
    const int domain = kFirst + (int(getpid()) * 7 + k) % kMany;
    if (hold_domain(domain)) return domain;
  }
  return fail(ErrorCode::io_failed,
              fmt::format("all private domains ({} to {}) are in use: stop other flights, or set "
                          "ROS_DOMAIN_ID",
                          kFirst, kFirst + kMany - 1));
}

}  // namespace goshawk::runtime
