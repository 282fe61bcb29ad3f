#include "session.hpp"

#include <fmt/format.h>

#include <limits>
#include <nlohmann/json.hpp>
#include <stdexcept>

namespace goshawk::viewer_bridge {
namespace {

using Json = nlohmann::json;

constexpr std::size_t kMostChannels = 1000;  // of one client, of each kind

// The library would cast 1e30 or -1, which no id is.
std::uint32_t id_of(const Json& value) {
  if (!value.is_number_unsigned()) throw std::invalid_argument("no id");
  const auto id = value.get<std::uint64_t>();
  if (id > std::numeric_limits<std::uint32_t>::max()) throw std::invalid_argument("no id");
  return std::uint32_t(id);
}

}  // namespace

const std::uint32_t* Session::subscription(std::uint32_t channel) const {
  const auto found = subscriptions_.find(channel);
  return found == subscriptions_.end() ? nullptr : &found->second;
}

bool Session::within_rate(int messages_per_s, std::chrono::steady_clock::time_point now) {
  if (now - window_ > std::chrono::seconds(1)) {
    window_ = now;
    in_window_ = 0;
  }
  return ++in_window_ <= messages_per_s;
}

Session::Answer Session::on_text(const std::string& text,
                                 const std::function<bool(std::uint32_t)>& known) {
  Answer answer;
  try {
    const Json message = Json::parse(text);
    const auto op = message.at("op").get<std::string>();
    if (op == "subscribe") {
      for (const auto& s : message.at("subscriptions")) {
        const auto channel = id_of(s.at("channelId"));
        if (!known(channel)) {
          answer.warnings.push_back(fmt::format("there is no channel {}", channel));
          continue;
        }
        if (subscriptions_.size() >= kMostChannels) break;
        subscriptions_[channel] = id_of(s.at("id"));
        ClientEvent event;
        event.client = client_;
        event.channel = channel;
        answer.events.push_back(event);
      }
    } else if (op == "unsubscribe") {
      for (const auto& id : message.at("subscriptionIds")) {
        std::erase_if(subscriptions_, [&](const auto& s) { return s.second == id_of(id); });
      }
    } else if (op == "advertise") {
      for (const auto& c : message.at("channels")) {
        if (published_.size() >= kMostChannels) break;
        Published p{c.at("topic").get<std::string>(), c.at("encoding").get<std::string>(),
                    c.at("schemaName").get<std::string>()};
        ClientEvent event;
        event.kind = ClientEvent::Kind::advertised;
        event.client = client_;
        event.topic = p.topic;
        event.encoding = p.encoding;
        event.schema_name = p.schema_name;
        answer.events.push_back(event);
        published_[id_of(c.at("id"))] = std::move(p);
      }
    } else if (op == "unadvertise") {
      for (const auto& id : message.at("channelIds")) published_.erase(id_of(id));
    } else {
      answer.warnings.push_back(fmt::format("unknown operation '{}'", op.substr(0, 40)));
    }
  } catch (const std::exception&) {
    answer.close = "not a foxglove.websocket.v1 message";
  }
  return answer;
}

Session::Answer Session::on_binary(const std::string& bytes) {
  Answer answer;
  if (bytes.size() < 5 || bytes[0] != 1) {
    answer.close = "not a binary foxglove.websocket.v1 message";
    return answer;
  }
  std::uint32_t channel = 0;
  for (int k = 0; k < 4; ++k) {
    channel |= std::uint32_t(static_cast<unsigned char>(bytes[std::size_t(k) + 1])) << (8 * k);
  }
  const auto found = published_.find(channel);
  if (found == published_.end()) {
    answer.warnings.push_back(fmt::format("channel {} was not advertised by this client", channel));
    return answer;
  }
  ClientEvent event;
  event.kind = ClientEvent::Kind::published;
  event.client = client_;
  event.topic = found->second.topic;
  event.schema_name = found->second.schema_name;
  event.encoding = found->second.encoding;
  event.bytes.assign(bytes.begin() + 5, bytes.end());
  answer.events.push_back(std::move(event));
  return answer;
}

}  // namespace goshawk::viewer_bridge
