#include "socket_server.hpp"

#include <map>
#include <mutex>
#include <thread>
#include <websocketpp/config/asio_no_tls.hpp>
#include <websocketpp/server.hpp>

namespace goshawk::viewer_bridge {
namespace {

using Endpoint = websocketpp::server<websocketpp::config::asio>;
using Handle = websocketpp::connection_hdl;
using ErrorCode = websocketpp::lib::error_code;

constexpr long kHandshake_ms = 5000;

}  // namespace

struct SocketServer::Impl {
  Options options;
  Callbacks callbacks;
  Endpoint endpoint;
  std::thread thread;
  int port = 0;

  mutable std::mutex mutex;  // of the three below; never held in a callback
  std::map<Handle, std::uint64_t, std::owner_less<Handle>> ids;
  std::map<std::uint64_t, Handle> handles;
  std::uint64_t next = 1;

  std::uint64_t id_of(const Handle& handle) const {
    const std::lock_guard<std::mutex> lock(mutex);
    const auto found = ids.find(handle);
    return found == ids.end() ? 0 : found->second;
  }

  Endpoint::connection_ptr connection(std::uint64_t client) {
    Handle handle;
    {
      const std::lock_guard<std::mutex> lock(mutex);
      const auto found = handles.find(client);
      if (found == handles.end()) return nullptr;
      handle = found->second;
    }
    ErrorCode ignored;
    return endpoint.get_con_from_hdl(handle, ignored);
  }

  bool on_validate(const Handle& handle) {
    const auto c = endpoint.get_con_from_hdl(handle);
    const std::string why = callbacks.validate(c->get_requested_subprotocols(), c->get_origin());
    if (why.empty()) {
      c->select_subprotocol(options.protocol);
      return true;
    }
    c->set_status(websocketpp::http::status_code::bad_request);
    c->set_body(why + "\n");
    return false;
  }

  void on_open(const Handle& handle) {
    std::uint64_t id = 0;
    {
      const std::lock_guard<std::mutex> lock(mutex);
      id = next++;
      ids[handle] = id;
      handles[id] = handle;
    }
    callbacks.opened(id);
  }

  void on_close(const Handle& handle) {
    std::uint64_t id = 0;
    {
      const std::lock_guard<std::mutex> lock(mutex);
      const auto found = ids.find(handle);
      if (found == ids.end()) return;
      id = found->second;
      handles.erase(id);
      ids.erase(found);
    }
    callbacks.closed(id);
  }

  void set_handlers() {
    endpoint.clear_access_channels(websocketpp::log::alevel::all);
    endpoint.clear_error_channels(websocketpp::log::elevel::all);
    endpoint.set_reuse_addr(true);
    endpoint.set_max_message_size(options.largest_message);
    endpoint.set_open_handshake_timeout(kHandshake_ms);
    endpoint.set_validate_handler([this](const Handle& h) { return on_validate(h); });
    endpoint.set_open_handler([this](const Handle& h) { on_open(h); });
    endpoint.set_close_handler([this](const Handle& h) { on_close(h); });
    endpoint.set_message_handler([this](const Handle& h, const Endpoint::message_ptr& m) {
      if (const auto id = id_of(h); id != 0) {
        callbacks.message(id, m->get_opcode() == websocketpp::frame::opcode::text,
                          m->get_payload());
      }
    });
  }
};

SocketServer::SocketServer(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}

std::unique_ptr<SocketServer> SocketServer::start(const Options& options, Callbacks callbacks,
                                                  std::string& why, bool& wrong_address) {
  auto impl = std::make_unique<Impl>();
  Impl& s = *impl;
  s.options = options;
  s.callbacks = std::move(callbacks);
  ErrorCode error;
  const auto address = asio::ip::make_address_v4(options.address, error);
  wrong_address = bool(error);
  if (!error) s.endpoint.init_asio(error);
  if (!error) {
    s.set_handlers();
    s.endpoint.listen(asio::ip::tcp::endpoint(address, options.port), error);
  }
  if (!error) s.endpoint.start_accept(error);
  if (error) {
    why = error.message();
    return nullptr;
  }
  s.port = s.endpoint.get_local_endpoint(error).port();
  s.thread = std::thread([&s] { s.endpoint.run(); });
  return std::unique_ptr<SocketServer>(new SocketServer(std::move(impl)));
}

SocketServer::~SocketServer() {
  impl_->endpoint.stop();
  impl_->thread.join();
}

int SocketServer::port() const {
  return impl_->port;
}

void SocketServer::send(std::uint64_t client, bool text, const std::string& payload) {
  // If it cannot be sent to any more, on_close() follows.
  if (const auto c = impl_->connection(client)) {
    c->send(payload, text ? websocketpp::frame::opcode::text : websocketpp::frame::opcode::binary);
  }
}

std::size_t SocketServer::waiting(std::uint64_t client) const {
  const auto c = impl_->connection(client);
  return c ? c->get_buffered_amount() : 0;
}

void SocketServer::close(std::uint64_t client, const std::string& why) {
  ErrorCode ignored;
  if (const auto c = impl_->connection(client)) {
    c->close(websocketpp::close::status::policy_violation, why.substr(0, 120), ignored);
  }
}

void SocketServer::cut(std::uint64_t client) {
  ErrorCode ignored;
  if (const auto c = impl_->connection(client)) {
    c->get_raw_socket().shutdown(asio::ip::tcp::socket::shutdown_both, ignored);
  }
}

}  // namespace goshawk::viewer_bridge
