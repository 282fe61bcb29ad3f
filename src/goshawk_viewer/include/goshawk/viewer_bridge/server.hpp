#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "goshawk/core/result.hpp"
#include "goshawk/viewer_bridge/origins.hpp"

namespace goshawk::viewer_bridge {

struct ServerOptions {
  std::string address =
      "127.0.0.1";  // IPv4 of this machine; anyone who can reach it can send goals
  int port = 8765;  // 0: any that is free
  std::string name = "goshawk";
  std::string origins = kDefaultOrigins;  // as Origins::parse() reads them
  int clients = 16;                       // at once
  std::size_t queue_bytes = 32U << 20U;   // unsent to one client; beyond it, messages are dropped
  double full_queue_s = 10.0;             // a client that never reads is closed after that
  int client_messages_per_s = 500;        // a client that sends more is closed
};

/// A topic as clients see it.
struct Channel {
  std::uint32_t id = 0;
  std::string topic;
  std::string schema_name;  // "nav_msgs/msg/Odometry"
  std::string schema;       // ROS 2 .msg text
};

/// What clients did, in the order in which they did it.
struct ClientEvent {
  enum class Kind { subscribed, advertised, published };
  Kind kind = Kind::subscribed;
  std::uint64_t client = 0;
  std::uint32_t channel = 0;         // subscribed
  std::string topic;                 // advertised, published
  std::string schema_name;           // advertised, published
  std::string encoding;              // advertised, published: "cdr" or "json"
  std::vector<unsigned char> bytes;  // published
};

enum class StatusLevel { info = 0, warning = 1, error = 2 };

/// The Foxglove WebSocket protocol, version 1 (foxglove.websocket.v1), without any middleware: it
/// offers channels, sends messages to their subscribers, and hands over what clients publish.
///
/// It never waits for a client and never keeps more for one than ServerOptions::queue_bytes. A
/// client that sends anything but messages of the protocol is closed with a sentence. All members
/// may be called from any thread; one thread of its own serves the sockets.
class Server {
 public:
  /// @return invalid_parameter for a bad address, port or list of origins; io_failed if the port is
  /// in use
  static Result<std::unique_ptr<Server>> start(const ServerOptions& options);
  ~Server();

  int port() const;
  int clients() const;
  std::uint64_t dropped() const;  // messages that slow clients did not get

  void advertise(const Channel& channel);
  /// To every client that subscribed to the channel. @param stamp_ns [ns] when it came
  void send(std::uint32_t channel, std::int64_t stamp_ns, std::span<const unsigned char> cdr);
  /// To one client only: what a late subscriber missed.
  void send_to(std::uint64_t client, std::uint32_t channel, std::int64_t stamp_ns,
               std::span<const unsigned char> cdr);
  /// A sentence that the client shows its user.
  void tell(std::uint64_t client, StatusLevel level, const std::string& sentence);

  /// @return what clients did since the last call
  std::vector<ClientEvent> take_events();
  /// @return sentences for the log since the last call: who came, who was closed and why
  std::vector<std::string> take_log();

 private:
  struct Impl;
  explicit Server(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace goshawk::viewer_bridge
