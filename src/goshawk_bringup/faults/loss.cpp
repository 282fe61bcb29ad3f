// Datagrams that are lost: on their way to the process, or from it.

#include <dlfcn.h>
#include <sys/socket.h>

#include "control.hpp"

namespace {

using goshawk::faults::Control;
using goshawk::faults::control;

constexpr std::uint64_t kMillion = 1'000'000;

/// splitmix64: the k-th draw follows from the seed alone.
std::uint64_t draw(std::uint64_t seed, std::uint64_t k) {
  std::uint64_t z = seed + (k + 1) * 0x9e3779b97f4a7c15u;
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
  return z ^ (z >> 31);
}

bool carries_datagrams(int socket) {
  int type = 0, domain = 0;
  socklen_t size = sizeof type;
  return getsockopt(socket, SOL_SOCKET, SO_TYPE, &type, &size) == 0 && type == SOCK_DGRAM &&
         getsockopt(socket, SOL_SOCKET, SO_DOMAIN, &domain, &size) == 0 && domain != AF_UNIX;
}

bool is_lost(int socket, std::atomic<std::uint32_t> Control::* loss_ppm) {
  Control* c = control();
  if (c == nullptr) return false;
  const std::uint32_t ppm = (c->*loss_ppm).load(std::memory_order_relaxed);
  if (ppm == 0 || !carries_datagrams(socket)) return false;
  const std::uint64_t k = c->drawn.fetch_add(1, std::memory_order_relaxed);
  if (draw(c->seed.load(std::memory_order_relaxed), k) % kMillion >= ppm) return false;
  c->lost.fetch_add(1, std::memory_order_relaxed);
  return true;
}

template <typename Function>
Function* own(const char* name) {
  return reinterpret_cast<Function*>(dlsym(RTLD_NEXT, name));
}

/// What comes and is not lost. An empty datagram is what ends a receiver's wait: it is never lost.
template <typename Receive>
ssize_t received(int socket, const Receive& receive) {
  while (true) {
    const ssize_t size = receive();
    if (size <= 0 || !is_lost(socket, &Control::receive_loss_ppm)) return size;
  }
}

ssize_t size_of(const msghdr& m) {
  ssize_t size = 0;
  for (std::size_t k = 0; k < m.msg_iovlen; ++k) size += ssize_t(m.msg_iov[k].iov_len);
  return size;
}

}  // namespace

extern "C" {

ssize_t recv(int socket, void* buffer, size_t size, int flags) {
  static auto* const next = own<ssize_t(int, void*, size_t, int)>("recv");
  return received(socket, [&] { return next(socket, buffer, size, flags); });
}

ssize_t recvfrom(int socket, void* buffer, size_t size, int flags, sockaddr* from,
                 socklen_t* from_size) {
  static auto* const next =
      own<ssize_t(int, void*, size_t, int, sockaddr*, socklen_t*)>("recvfrom");
  const socklen_t room = from_size == nullptr ? 0 : *from_size;
  return received(socket, [&] {
    if (from_size != nullptr) *from_size = room;
    return next(socket, buffer, size, flags, from, from_size);
  });
}

ssize_t recvmsg(int socket, msghdr* message, int flags) {
  static auto* const next = own<ssize_t(int, msghdr*, int)>("recvmsg");
  const msghdr room = *message;
  return received(socket, [&] {
    *message = room;
    return next(socket, message, flags);
  });
}

ssize_t sendto(int socket, const void* buffer, size_t size, int flags, const sockaddr* to,
               socklen_t to_size) {
  static auto* const next =
      own<ssize_t(int, const void*, size_t, int, const sockaddr*, socklen_t)>("sendto");
  if (is_lost(socket, &Control::send_loss_ppm)) return ssize_t(size);
  return next(socket, buffer, size, flags, to, to_size);
}

ssize_t sendmsg(int socket, const msghdr* message, int flags) {
  static auto* const next = own<ssize_t(int, const msghdr*, int)>("sendmsg");
  if (is_lost(socket, &Control::send_loss_ppm)) return size_of(*message);
  return next(socket, message, flags);
}

}  // extern "C"
