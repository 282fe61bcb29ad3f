#include <fmt/format.h>
#include <spdlog/spdlog.h>
#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <sstream>
#include <thread>

#include "foxglove_times.hpp"
#include "goshawk/introspection/codec.hpp"
#include "goshawk/introspection/schema.hpp"
#include "goshawk/runtime/component.hpp"
#include "goshawk/stage/stage_reporter.hpp"
#include "goshawk/viewer_bridge/server.hpp"
#include "goshawk/why/why.hpp"
#include "goshawk/why_messages/snapshot_collector.hpp"
#include "std_msgs.h"

namespace goshawk::viewer_bridge {

struct Config {
  std::string address = "127.0.0.1";
  int port = 8765;
  std::string origins = kDefaultOrigins;
  std::string publish_topics = "goal_pose,operator_command";
  int queue_mb = 32;
  int clients = 16;
};

template <typename Self, typename Visitor>
requires std::same_as<std::remove_const_t<Self>, Config>
void describe(Self& c, Visitor&& visit) {
  visit("address", c.address, "",
        "IPv4 address to listen on; anyone who can reach it can send goals", Anything{});
  visit("port", c.port, "", "TCP port to listen on; 0: any free one", Range{0, 65535});
  visit("origins", c.origins, "",
        "web pages that may connect, as http://host:port with commas between them; any: all",
        Anything{});
  visit("publish_topics", c.publish_topics, "",
        "topics that clients may publish on, with commas between them; any: all", Anything{});
  visit("queue_mb", c.queue_mb, "MB", "queue for one slow client; messages beyond it are dropped",
        Range{1, 1024});
  visit("clients", c.clients, "", "largest number of clients at once", Range{1, 1000});
}

namespace {

using namespace goshawk::runtime;
using namespace goshawk::stage;

constexpr double kLookAround_s = 0.5;
constexpr double kServe_s = 0.01;
constexpr double kExplain_s = 0.5;
constexpr std::size_t kKept = 20;              // newest messages of a latched topic, ...
constexpr std::size_t kKeptBytes = 1U << 20U;  // ... or one, if they are larger

std::set<std::string> split(const std::string& list) {
  std::set<std::string> words;
  std::istringstream in(list);
  for (std::string word; std::getline(in, word, ',');) words.insert(word);
  return words;
}

ServerOptions server_options(const Config& c) {
  ServerOptions options;
  options.address = c.address;
  options.port = c.port;
  options.origins = c.origins;
  options.clients = c.clients;
  options.queue_bytes = std::size_t(c.queue_mb) << 20U;
  return options;
}

/// A topic of the domain: read from the first subscription on.
struct Topic {
  std::string name;
  const introspection::Type* type = nullptr;
  bool reliable = true;
  bool latched = true;
  bool read = false;
  struct Message {
    std::int64_t stamp_ns;
    std::vector<unsigned char> cdr;
  };
  std::vector<Message> kept;  // of a latched topic, for who subscribes late
};

/// Carries every topic of the domain to Foxglove clients, and their goals back. It joins the
/// domain once more, as a participant of its own: so it also sees the stages of its own process.
class ViewerBridgeComponent : public Component {
 public:
  explicit ViewerBridgeComponent(Node& node)
      : node_(node),
        config_(node.parameters<Config>()),
        server_(start_server(config_)),
        context_(join()),
        why_(node.advertise<std_msgs::msg::String>("why", Qos::reliable_last())),
        dds_(*context_, "viewer_bridge_reader"),
        reporter_(node, StageRole::viewer, "foxglove.websocket.v1") {
    dds_.every(kLookAround_s, [this] { look_around(); });
    dds_.every(kServe_s, [this] { serve(); });
    node_.every(kExplain_s, [this] { explain(); });
    thread_ = std::thread([this] { dds_.spin(); });
    reporter_.ready(fmt::format("listens on ws://{}:{}", config_.address, server_->port()));
  }

  ~ViewerBridgeComponent() override {
    dds_.stop();
    thread_.join();
  }

 private:
  static std::unique_ptr<Server> start_server(const Config& config) {
    auto server = Server::start(server_options(config));
    if (!server) throw StartupFault(server.error());
    return *std::move(server);
  }

  static std::unique_ptr<Context> join() {
    auto options = ContextOptions::from_environment();
    if (!options) throw StartupFault(options.error());
    auto context = Context::create(*options);
    if (!context) throw StartupFault(context.error());
    return *std::move(context);
  }

  // The sentences of `goshawk why`, while somebody reads them. It listens from the first reader on,
  // because it needs the map, and explains once a silent stage could be told from one not yet
  // heard.
  void explain() {
    if (why_.matched() == 0) return;
    if (!collector_) {
      collector_.emplace();
      collector_->listen(node_, "");
      listening_since_ns_ = node_.monotonic_ns();
    }
    if (double(node_.monotonic_ns() - listening_since_ns_) < 1.2e9 * why::kSilent_s) return;
    const why::Reason reason = why::explain(collector_->snapshot(node_.now_ns()));
    std_msgs::msg::String sentences;
    for (const std::string& sentence : {reason.doing, reason.because, reason.mend}) {
      if (sentence.empty()) continue;
      sentences.data() += sentences.data().empty() ? sentence : " " + sentence;
    }
    if (auto sent = why_.publish(sentences); !sent) node_.log().warn("{}", sent.error().message);
  }

  // New topics become channels. What is gone stays: a stage that is restarted writes on.
  void look_around() {
    std::map<std::string, Topic> found;
    for (const auto& e : context_->endpoints()) {
      // A topic that clients may publish on may have readers only; Foxglove needs its type.
      if ((!e.writer && !may_publish(e.topic)) || known_.contains(e.topic)) continue;
      const auto type = introspection::find_type(e.type);
      if (!type) continue;
      Topic& topic = found.try_emplace(e.topic).first->second;
      topic.name = e.topic;
      topic.type = *type;
      topic.reliable = topic.reliable && e.reliable;
      topic.latched = topic.latched && e.transient_local;
    }
    for (auto& [name, topic] : found) {
      const std::uint32_t id = next_channel_++;
      known_.insert(name);
      server_->advertise({id, name, std::string(topic.type->name),
                          introspection::ros_msg_definition(*topic.type)});
      topics_.emplace(id, std::move(topic));
    }
  }

  bool may_publish(const std::string& topic) const {
    const auto allowed = split(config_.publish_topics);
    const std::string name = topic.starts_with('/') ? topic.substr(1) : topic;
    return allowed.contains("any") || allowed.contains(name) || allowed.contains("/" + name);
  }

  void serve() {
    for (const auto& line : server_->take_log()) node_.log().info("{}", line);
    for (auto& event : server_->take_events()) {
      switch (event.kind) {
        case ClientEvent::Kind::subscribed:
          on_subscribed(event);
          break;
        case ClientEvent::Kind::advertised:
          publisher_for(event);
          break;
        case ClientEvent::Kind::published:
          on_published(event);
          break;
      }
    }
  }

  void on_subscribed(const ClientEvent& event) {
    Topic& topic = topics_.at(event.channel);
    for (const auto& m : topic.kept)
      server_->send_to(event.client, event.channel, m.stamp_ns, m.cdr);
    if (topic.read) return;
    topic.read = true;
    // Readers only ask for what every writer offers.
    const Qos qos{topic.reliable, topic.latched, topic.reliable ? 100 : 10};
    types_.push_back(std::make_unique<MessageType>(
        raw_message_type(wire_type_name(std::string(topic.type->name)))));
    dds_.subscribe_raw(topic.name, *types_.back(), qos,
                       [this, id = event.channel](const void* data, const MessageInfo& info) {
                         on_message(id, *static_cast<const std::vector<unsigned char>*>(data),
                                    info.received_ns);
                       });
  }

  void on_message(std::uint32_t id, const std::vector<unsigned char>& cdr, std::int64_t stamp_ns) {
    server_->send(id, stamp_ns, cdr);
    Topic& topic = topics_.at(id);
    if (!topic.latched) return;
    const std::size_t most = cdr.size() > kKeptBytes ? 1 : kKept;
    while (topic.kept.size() >= most) topic.kept.erase(topic.kept.begin());
    topic.kept.push_back({stamp_ns, cdr});
  }

  /// @return where the client's messages go, or nullptr: a client that sends was told why
  RawPublisher* publisher_for(const ClientEvent& event) {
    const std::string name = event.topic.starts_with('/') ? event.topic.substr(1) : event.topic;
    // Viewers advertise more than they ever send (Foxglove's 3D panel three topics), and Foxglove
    // counts every status as a problem: a client is told only when it sends.
    const bool sends = event.kind == ClientEvent::Kind::published;
    const auto refuse = [&](const std::string& why) {
      const auto sentence = event.topic.substr(0, 100) + ": " + why;
      if (sends) server_->tell(event.client, StatusLevel::error, sentence);
      return nullptr;
    };
    if (!may_publish(name)) {
      return refuse("clients may not publish on this topic; publish_topics allows " +
                    config_.publish_topics);
    }
    if (auto ok = check_topic_name(name); !ok) return refuse(ok.error().message);
    const auto type = introspection::find_type(event.schema_name);
    if (!type) return refuse(type.error().message);
    if (event.encoding != "cdr" && event.encoding != "json") {
      return refuse("the encoding must be cdr or json");
    }
    auto found = publishers_.find({name, (*type)->name});
    if (found != publishers_.end()) return &found->second;
    types_.push_back(std::make_unique<MessageType>(
        raw_message_type(wire_type_name(std::string((*type)->name)))));
    // In the vehicle's namespace, as the component itself.
    const std::string own = node_.full_name();
    const std::string prefix = own.substr(0, own.rfind('/') + 1);
    const std::string full = event.topic.starts_with('/') ? event.topic : prefix + name;
    auto publisher = dds_.advertise_raw(full, *types_.back(), Qos::reliable_last());
    return &publishers_.emplace(std::pair{name, (*type)->name}, publisher).first->second;
  }

  void on_published(const ClientEvent& event) {
    const RawPublisher* publisher = publisher_for(event);
    if (publisher == nullptr) return;
    const auto tell = [&](StatusLevel level, const std::string& why) {
      server_->tell(event.client, level, event.topic + ": " + why);
    };
    const auto* type = *introspection::find_type(event.schema_name);
    auto cdr = to_cdr(*type, event);
    if (!cdr) return tell(StatusLevel::error, cdr.error().message);
    if (publisher->matched() == 0) tell(StatusLevel::warning, "no node reads this topic");
    if (auto sent = publisher->publish_raw(&*cdr); !sent) {
      tell(StatusLevel::error, sent.error().message);
    }
  }

  // CDR from a client is checked here, before it reaches a stage.
  static Result<std::vector<unsigned char>> to_cdr(const introspection::Type& type,
                                                   const ClientEvent& event) {
    if (event.encoding == "cdr") {
      if (auto json = introspection::cdr_to_json(type, event.bytes); !json) return json.error();
      return event.bytes;
    }
    auto json =
        nlohmann::ordered_json::parse(event.bytes.begin(), event.bytes.end(), nullptr, false);
    rename_nanoseconds(json);
    if (json.is_discarded()) return fail(ErrorCode::invalid_input, "the message is not valid JSON");
    return introspection::json_to_cdr(type, json);
  }

  Node& node_;
  Config config_;
  std::unique_ptr<Server> server_;
  std::unique_ptr<Context> context_;
  std::optional<why::SnapshotCollector> collector_;  // in the node's own thread
  std::int64_t listening_since_ns_ = 0;
  Publisher<std_msgs::msg::String> why_;
  // From here on used by the thread alone.
  std::vector<std::unique_ptr<MessageType>> types_;
  std::map<std::uint32_t, Topic> topics_;
  std::set<std::string> known_;
  std::uint32_t next_channel_ = 1;
  Node dds_;
  std::map<std::pair<std::string, std::string_view>, RawPublisher> publishers_;
  StageReporter reporter_;
  std::thread thread_;
};

}  // namespace
}  // namespace goshawk::viewer_bridge

GOSHAWK_REGISTER_COMPONENT(goshawk::viewer_bridge::ViewerBridgeComponent,
                           goshawk::viewer_bridge::Config)
