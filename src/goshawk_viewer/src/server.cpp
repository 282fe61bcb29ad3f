#include "goshawk/viewer_bridge/server.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <map>
#include <mutex>
#include <nlohmann/json.hpp>

#include "session.hpp"
#include "socket_server.hpp"

namespace goshawk::viewer_bridge {
namespace {

using Json = nlohmann::json;
using Steady = std::chrono::steady_clock;

constexpr const char* kProtocol = "foxglove.websocket.v1";
constexpr std::size_t kMostEvents = 1000;
constexpr std::size_t kLargestClientMessage = 1U << 20U;

struct Client {
  explicit Client(std::uint64_t id) : session(id) {}

  Session session;
  std::uint64_t dropped = 0;
  Steady::time_point full_since{};  // the queue has been full from then on
};

Json to_json(const Channel& c) {
  return {{"id", c.id},         {"topic", c.topic},
          {"encoding", "cdr"},  {"schemaName", c.schema_name},
          {"schema", c.schema}, {"schemaEncoding", "ros2msg"}};
}

Json to_json(StatusLevel level, const std::string& sentence) {
  return {{"op", "status"}, {"level", int(level)}, {"message", sentence}};
}

void put(std::string& bytes, std::uint64_t value, int count) {
  for (int k = 0; k < count; ++k) bytes += static_cast<char>(value >> (8 * k) & 255U);
}

std::string message_frame(std::uint32_t subscription, std::int64_t stamp_ns,
                          std::span<const unsigned char> cdr) {
  std::string frame;
  frame.reserve(cdr.size() + 13);
  put(frame, 1, 1);
  put(frame, subscription, 4);
  put(frame, std::uint64_t(stamp_ns), 8);
  frame.append(reinterpret_cast<const char*>(cdr.data()), cdr.size());
  return frame;
}

}  // namespace

struct Server::Impl {
  ServerOptions options;
  Origins origins;

  mutable std::mutex mutex;  // of everything below but the sockets
  std::map<std::uint64_t, Client> clients;
  std::map<std::uint32_t, Channel> channels;
  std::vector<ClientEvent> events;
  std::vector<std::string> log;
  std::uint64_t dropped = 0;
  std::unique_ptr<SocketServer> sockets;  // last: its thread ends before the rest goes

  void note(const std::string& sentence) {
    if (log.size() < kMostEvents) log.push_back(sentence);
  }

  void send_text(std::uint64_t client, const Json& message) {
    sockets->send(client, true, message.dump(-1, ' ', false, Json::error_handler_t::replace));
  }

  void close(std::uint64_t client, const std::string& why) {
    note(fmt::format("client {} closed: {}", client, why));
    sockets->close(client, why);
  }

  std::string reason_to_refuse(const std::vector<std::string>& protocols,
                               const std::string& origin) const {
    if (std::ranges::find(protocols, kProtocol) == protocols.end()) {
      return fmt::format("this server speaks {}; connect with Foxglove, Lichtblick or goshawk view",
                         kProtocol);
    }
    if (!origins.allow(origin)) {
      return fmt::format("pages from {0} may not connect; -p origins:={0} allows them",
                         origin.substr(0, 80));
    }
    if (int(clients.size()) < options.clients) return {};
    return fmt::format("the limit of {} clients is reached", options.clients);
  }

  std::string on_validate(const std::vector<std::string>& protocols, const std::string& origin) {
    const std::scoped_lock lock(mutex);
    const std::string why = reason_to_refuse(protocols, origin);
    if (!why.empty()) note("refused: " + why);
    return why;
  }

  void on_opened(std::uint64_t client) {
    const std::scoped_lock lock(mutex);
    clients.emplace(client, Client(client));
    note(fmt::format("client {} connected", client));
    send_text(client, {{"op", "serverInfo"},
                       {"name", options.name},
                       {"capabilities", {"clientPublish"}},
                       {"supportedEncodings", {"json", "cdr"}},
                       {"metadata", Json::object()}});
    Json list = Json::array();
    for (const auto& [id, channel] : channels) list.push_back(to_json(channel));
    send_text(client, {{"op", "advertise"}, {"channels", list}});
  }

  void on_closed(std::uint64_t client) {
    const std::scoped_lock lock(mutex);
    const auto found = clients.find(client);
    if (found == clients.end()) return;
    const auto missed = found->second.dropped;
    note(missed == 0 ? fmt::format("client {} left", client)
                     : fmt::format("client {} left; it missed {} messages", client, missed));
    clients.erase(found);
  }

  void on_message(std::uint64_t client, bool text, const std::string& payload) {
    const std::scoped_lock lock(mutex);
    const auto found = clients.find(client);
    if (found == clients.end()) return;
    Session& session = found->second.session;
    if (session.closed()) return;
    if (!session.within_rate(options.client_messages_per_s, Steady::now())) {
      session.set_closed();
      return close(client,
                   fmt::format("more than {} messages a second", options.client_messages_per_s));
    }
    auto answer = text ? session.on_text(payload, [&](auto id) { return channels.contains(id); })
                       : session.on_binary(payload);
    for (const auto& warning : answer.warnings) {
      send_text(client, to_json(StatusLevel::warning, warning));
    }
    for (auto& event : answer.events) {
      if (events.size() < kMostEvents) events.push_back(std::move(event));
    }
    if (!answer.close.empty()) {
      session.set_closed();
      close(client, answer.close);
    }
  }

  void send_message(std::uint64_t id, Client& client, std::uint32_t channel, std::int64_t stamp_ns,
                    std::span<const unsigned char> cdr) {
    const auto* subscription = client.session.subscription(channel);
    if (subscription == nullptr) return;
    const std::size_t waiting = sockets->waiting(id);
    // One message may be larger than the queue if nothing else waits.
    if (waiting > 0 && waiting + cdr.size() > options.queue_bytes) return drop(id, client);
    client.full_since = {};
    sockets->send(id, false, message_frame(*subscription, stamp_ns, cdr));
  }

  void drop(std::uint64_t id, Client& client) {
    ++dropped;
    ++client.dropped;
    const auto now = Steady::now();
    if (client.full_since == Steady::time_point{}) client.full_since = now;
    const std::chrono::duration<double> full = now - client.full_since;
    if (full.count() < options.full_queue_s || client.session.closed()) return;
    client.session.set_closed();
    note(fmt::format("client {} closed: it does not read what it subscribed to", id));
    sockets->cut(id);
  }
};

Server::Server(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
Server::~Server() = default;

Result<std::unique_ptr<Server>> Server::start(const ServerOptions& options) {
  const std::string place = fmt::format("port {} of {}", options.port, options.address);
  if (options.port < 0 || options.port > 65535) {
    return fail(ErrorCode::invalid_parameter, place + ": ports go from 0 to 65535");
  }
  auto origins = Origins::parse(options.origins);
  if (!origins) return origins.error();
  auto impl = std::make_unique<Impl>();
  Impl& s = *impl;
  s.options = options;
  s.origins = *std::move(origins);
  SocketServer::Callbacks callbacks;
  callbacks.validate = [&s](const auto& p, const auto& o) { return s.on_validate(p, o); };
  callbacks.opened = [&s](std::uint64_t c) { s.on_opened(c); };
  callbacks.closed = [&s](std::uint64_t c) { s.on_closed(c); };
  callbacks.message = [&s](std::uint64_t c, bool text, const std::string& payload) {
    s.on_message(c, text, payload);
  };
  SocketServer::Options sockets{options.address, std::uint16_t(options.port), kProtocol,
                                kLargestClientMessage};
  std::string why;
  bool wrong_address = false;
  {
    const std::scoped_lock lock(s.mutex);  // a client that is there at once finds the sockets
    s.sockets = SocketServer::start(sockets, std::move(callbacks), why, wrong_address);
  }
  if (wrong_address) {
    return fail(ErrorCode::invalid_parameter,
                fmt::format("'{}' is not an IPv4 address", options.address));
  }
  if (s.sockets == nullptr) {
    return fail(ErrorCode::io_failed,
                fmt::format("{} cannot be used ({}): is another bridge running? -p port:=N takes "
                            "another port",
                            place, why));
  }
  return std::unique_ptr<Server>(new Server(std::move(impl)));
}

int Server::port() const {
  return impl_->sockets->port();
}

int Server::clients() const {
  const std::scoped_lock lock(impl_->mutex);
  return int(impl_->clients.size());
}

std::uint64_t Server::dropped() const {
  const std::scoped_lock lock(impl_->mutex);
  return impl_->dropped;
}

void Server::advertise(const Channel& channel) {
  const std::scoped_lock lock(impl_->mutex);
  impl_->channels[channel.id] = channel;
  const Json message{{"op", "advertise"}, {"channels", Json::array({to_json(channel)})}};
  for (auto& [id, client] : impl_->clients) impl_->send_text(id, message);
}

void Server::send(std::uint32_t channel, std::int64_t stamp_ns,
                  std::span<const unsigned char> cdr) {
  const std::scoped_lock lock(impl_->mutex);
  for (auto& [id, client] : impl_->clients) impl_->send_message(id, client, channel, stamp_ns, cdr);
}

void Server::send_to(std::uint64_t client, std::uint32_t channel, std::int64_t stamp_ns,
                     std::span<const unsigned char> cdr) {
  const std::scoped_lock lock(impl_->mutex);
  const auto found = impl_->clients.find(client);
  if (found == impl_->clients.end()) return;
  impl_->send_message(client, found->second, channel, stamp_ns, cdr);
}

void Server::tell(std::uint64_t client, StatusLevel level, const std::string& sentence) {
  const std::scoped_lock lock(impl_->mutex);
  if (impl_->clients.contains(client)) impl_->send_text(client, to_json(level, sentence));
}

std::vector<ClientEvent> Server::take_events() {
  const std::scoped_lock lock(impl_->mutex);
  return std::exchange(impl_->events, {});
}

std::vector<std::string> Server::take_log() {
  const std::scoped_lock lock(impl_->mutex);
  return std::exchange(impl_->log, {});
}

}  // namespace goshawk::viewer_bridge
