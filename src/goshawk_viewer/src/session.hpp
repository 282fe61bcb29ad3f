#pragma once

#include <chrono>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "goshawk/viewer_bridge/server.hpp"

namespace goshawk::viewer_bridge {

/// What one client said it wants, read from its messages; no sockets in it.
class Session {
 public:
  struct Answer {
    std::string close;                  // why the client must go; empty: it may stay
    std::vector<std::string> warnings;  // to be told to the client
    std::vector<ClientEvent> events;
  };

  explicit Session(std::uint64_t client) : client_(client) {}

  /// @param known whether there is a channel of that id
  Answer on_text(const std::string& text, const std::function<bool(std::uint32_t)>& known);
  Answer on_binary(const std::string& bytes);

  /// @return the subscription of that channel, or nullptr
  const std::uint32_t* subscription(std::uint32_t channel) const;

  /// Counts one message. @return whether the client sends no more than it may
  bool within_rate(int messages_per_s, std::chrono::steady_clock::time_point now);

  /// Nothing more is taken from a client that is being closed.
  bool closed() const { return closed_; }
  void set_closed() { closed_ = true; }

 private:
  struct Published {
    std::string topic;
    std::string encoding;
    std::string schema_name;
  };

  std::uint64_t client_;
  std::map<std::uint32_t, std::uint32_t> subscriptions_;  // channel -> subscription
  std::map<std::uint32_t, Published> published_;          // channel of the client
  std::chrono::steady_clock::time_point window_{};
  int in_window_ = 0;
  bool closed_ = false;
};

}  // namespace goshawk::viewer_bridge
