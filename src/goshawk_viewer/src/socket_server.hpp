#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace goshawk::viewer_bridge {

/// WebSockets, and nothing of what is said over them. This part is C++17, because WebSocket++'s
/// headers (0.8.2) are not C++20.
class SocketServer {
 public:
  struct Callbacks {  // called in the server's thread; they may call send(), close() and cut()
    /// @return why the client is refused, or nothing
    std::function<std::string(const std::vector<std::string>& protocols, const std::string& origin)>
        validate;
    std::function<void(std::uint64_t client)> opened;
    std::function<void(std::uint64_t client)> closed;
    std::function<void(std::uint64_t client, bool text, const std::string& payload)> message;
  };
  struct Options {
    std::string address;
    std::uint16_t port = 0;           // 0: any that is free
    std::string protocol;             // selected for every client
    std::size_t largest_message = 0;  // [byte] from a client; it is closed beyond
  };

  /// @param why set if the address is wrong (wrong_address) or the port cannot be used
  /// @return nullptr then
  static std::unique_ptr<SocketServer> start(const Options& options, Callbacks callbacks,
                                             std::string& why, bool& wrong_address);
  ~SocketServer();

  int port() const;
  void send(std::uint64_t client, bool text, const std::string& payload);
  std::size_t waiting(std::uint64_t client) const;  // [byte] not yet given to the network
  void close(std::uint64_t client, const std::string& why);
  /// Without the closing handshake, which would wait behind what the client does not read.
  void cut(std::uint64_t client);

 private:
  struct Impl;
  explicit SocketServer(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace goshawk::viewer_bridge
