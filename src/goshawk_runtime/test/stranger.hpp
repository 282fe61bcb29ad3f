#pragma once

#include <arpa/inet.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cstddef>
#include <span>

#include "udp_sockets.hpp"

namespace goshawk::runtime_test {

/// A socket of somebody else on this machine, who sends what he likes.
class Stranger {
 public:
  Stranger() : socket_(::socket(AF_INET, SOCK_DGRAM, 0)) {}
  ~Stranger() { close(socket_); }
  Stranger(const Stranger&) = delete;
  Stranger& operator=(const Stranger&) = delete;

  void send(std::span<const std::byte> datagram, unsigned port) const {
    sockaddr_in to{};
    to.sin_family = AF_INET;
    to.sin_port = htons(std::uint16_t(port));
    to.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    (void)sendto(socket_, datagram.data(), datagram.size(), 0,
                 reinterpret_cast<const sockaddr*>(&to), sizeof to);
  }
  void send_to_all(std::span<const std::byte> datagram, const std::string& pid = "self") const {
    for (const auto& socket : udp_sockets(pid)) send(datagram, socket.port);
  }

 private:
  int socket_;
};

}  // namespace goshawk::runtime_test
