#pragma once

#include <arpa/inet.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <chrono>
#include <cstdint>
#include <string>
#include <vector>

namespace goshawk::viewer_bridge {

/// A WebSocket client of a few lines, which can also misbehave.
class RawClient {
 public:
  struct Frame {
    int opcode = 0;  // 1 text, 2 binary, 8 close
    std::string payload;
  };

  explicit RawClient(int port, int receive_buffer = 0)
      : socket_(::socket(AF_INET, SOCK_STREAM, 0)) {
    if (receive_buffer > 0) {
      ::setsockopt(socket_, SOL_SOCKET, SO_RCVBUF, &receive_buffer, sizeof receive_buffer);
    }
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(std::uint16_t(port));
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    connected_ = ::connect(socket_, reinterpret_cast<sockaddr*>(&address), sizeof address) == 0;
  }
  ~RawClient() { ::close(socket_); }
  RawClient(const RawClient&) = delete;
  RawClient& operator=(const RawClient&) = delete;

  bool connected() const { return connected_; }

  void write(const std::string& bytes) const {
    (void)::send(socket_, bytes.data(), bytes.size(), MSG_NOSIGNAL);
  }

  /// @return the head of the server's answer
  std::string shake_hands(const std::string& protocol = "foxglove.websocket.v1",
                          const std::string& origin = "") {
    write(
        "GET / HTTP/1.1\r\nHost: localhost\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n"
        "Sec-WebSocket-Key: AAAAAAAAAAAAAAAAAAAAAA==\r\nSec-WebSocket-Version: 13\r\n" +
        (protocol.empty() ? "" : "Sec-WebSocket-Protocol: " + protocol + "\r\n") +
        (origin.empty() ? "" : "Origin: " + origin + "\r\n") + "\r\n");
    while (buffer_.find("\r\n\r\n") == std::string::npos && fill(3000)) {
    }
    const auto end = buffer_.find("\r\n\r\n");
    if (end == std::string::npos) return buffer_;
    std::string head = buffer_.substr(0, end + 4);
    buffer_.erase(0, end + 4);
    if (!head.starts_with("HTTP/1.1 101")) head += buffer_;
    return head;
  }

  void send_text(const std::string& text) const { send_frame(1, text); }
  void send_frame(int opcode, const std::string& payload) const {
    std::string frame(1, char(0x80 | opcode));
    if (payload.size() < 126) {
      frame += char(0x80 | payload.size());
    } else {
      frame += char(0x80 | 127);
      for (int k = 7; k >= 0; --k) frame += char(payload.size() >> (8 * k) & 255U);
    }
    write(frame + std::string(4, '\0') + payload);  // masked with zeros
  }

  /// @return false if none came in time, or the connection is closed
  bool read(Frame& frame, int timeout_ms = 60000) {
    const auto have = [&](std::size_t n) {
      while (buffer_.size() < n) {
        if (!fill(timeout_ms)) return false;
      }
      return true;
    };
    if (!have(2)) return false;
    std::size_t size = static_cast<unsigned char>(buffer_[1]) & 127U;
    std::size_t head = 2;
    const std::size_t more = size == 126 ? 2 : size == 127 ? 8 : 0;
    if (!have(head + more)) return false;
    if (more > 0) size = 0;
    for (std::size_t k = 0; k < more; ++k) {
      size = size << 8U | static_cast<unsigned char>(buffer_[head + k]);
    }
    head += more;
    if (!have(head + size)) return false;
    frame = {buffer_[0] & 15, buffer_.substr(head, size)};
    buffer_.erase(0, head + size);
    return true;
  }

  /// Reads until a frame of that opcode. @return its payload, or "nothing"
  std::string wait_for(int opcode, int timeout_ms = 60000) {
    Frame frame;
    while (read(frame, timeout_ms)) {
      if (frame.opcode == opcode) return frame.payload;
    }
    return "nothing";
  }

 private:
  bool fill(int timeout_ms) {
    pollfd p{socket_, POLLIN, 0};
    if (::poll(&p, 1, timeout_ms) <= 0) return false;
    char bytes[65536];
    const ssize_t count = ::recv(socket_, bytes, sizeof bytes, 0);
    if (count <= 0) return false;
    buffer_.append(bytes, std::size_t(count));
    return true;
  }

  int socket_;
  bool connected_ = false;
  std::string buffer_;
};

}  // namespace goshawk::viewer_bridge
