#include "goshawk/introspection/graph.hpp"

#include <algorithm>
#include <optional>

#include "goshawk/introspection/services.hpp"

namespace goshawk::introspection {
namespace {

std::vector<std::string> nodes_of(const std::string& participant,
                                  const std::vector<runtime::ParticipantInfo>& participants) {
  const auto found =
      std::ranges::find(participants, participant, &runtime::ParticipantInfo::guid_prefix);
  return found == participants.end() ? std::vector<std::string>() : found->nodes;
}

}  // namespace

NodeList list_nodes(Session& session, double timeout_s) {
  session.settle(timeout_s);
  NodeList list;
  for (const auto& participant : session.context().participants()) {
    for (const auto& name : participant.nodes) list.nodes.push_back({name, participant.name});
    if (participant.nodes.empty()) ++list.unnamed_participants;
  }
  std::ranges::sort(list.nodes, {}, [](const NodeInfo& n) { return std::tie(n.name, n.process); });
  return list;
}

Result<NodeDetails> node_info(Session& session, const std::string& name, double timeout_s) {
  const auto full = full_topic_name(name);  // the same letters may stand in both
  if (!full) return full.error();
  const auto find = [&]() -> std::optional<runtime::ParticipantInfo> {
    for (auto& participant : session.context().participants()) {
      if (std::ranges::find(participant.nodes, *full) != participant.nodes.end()) {
        return std::move(participant);
      }
    }
    return {};
  };
  session.wait_for(timeout_s, [&] { return find().has_value(); });
  session.settle(timeout_s);
  const auto participant = find();
  if (!participant) return session.no_node(*full);
  NodeDetails details{*full, participant->name, participant->nodes, {}, {}, {}};
  std::erase(details.others, *full);
  std::ranges::sort(details.others);
  for (const auto& endpoint : session.context().endpoints()) {
    if (endpoint.participant != participant->guid_prefix) continue;
    if (const auto end = service_end(endpoint)) {
      if (end->is_server) details.services[end->name] = end->type;
      continue;
    }
    (endpoint.writer ? details.publishers : details.subscribers)[endpoint.topic] = endpoint.type;
  }
  return details;
}

std::map<std::string, TopicSummary> list_topics(Session& session, double timeout_s) {
  session.settle(timeout_s);
  std::map<std::string, TopicSummary> topics;
  for (const auto& endpoint : session.context().endpoints()) {
    if (service_end(endpoint)) continue;
    auto& topic = topics[endpoint.topic];
    topic.types.insert(endpoint.type);
    ++(endpoint.writer ? topic.publishers : topic.subscribers);
  }
  return topics;
}

Result<TopicInfo> topic_info(Session& session, const std::string& topic, double timeout_s) {
  auto name = full_topic_name(topic);
  if (!name) return name.error();
  if (!session.wait_for(timeout_s, [&] { return !session.endpoints_of(*name).empty(); })) {
    return session.no_topic(*name, timeout_s);
  }
  session.settle(timeout_s);
  const auto participants = session.context().participants();
  TopicInfo info;
  info.name = *name;
  for (auto& endpoint : session.endpoints_of(*name)) {
    info.types.insert(endpoint.type);
    auto nodes = nodes_of(endpoint.participant, participants);
    auto& list = endpoint.writer ? info.publishers : info.subscribers;
    list.push_back({std::move(nodes), std::move(endpoint)});
  }
  return info;
}

}  // namespace goshawk::introspection
