#include <iostream>
#include <map>
#include <set>

#include "text.hpp"
#include "topic_verbs.hpp"

namespace goshawk::introspection {
namespace {

using Json = nlohmann::ordered_json;

struct TopicSummary {
  std::set<std::string> types;
  int publishers = 0;
  int subscribers = 0;
};

std::map<std::string, TopicSummary> summarise(const std::vector<runtime::EndpointInfo>& endpoints) {
  std::map<std::string, TopicSummary> topics;
  for (const auto& endpoint : endpoints) {
    auto& topic = topics[endpoint.topic];
    topic.types.insert(endpoint.type);
    ++(endpoint.writer ? topic.publishers : topic.subscribers);
  }
  return topics;
}

std::string joined(const auto& words) {
  std::string text;
  for (const auto& word : words) text += (text.empty() ? "" : ", ") + word;
  return text;
}

int list(const CommonOptions& common, bool with_types) {
  auto session = Session::open();
  if (!session) return say_wrong_call(session.error().message);
  auto& context = (*session)->context();
  (*session)->settle(common.timeout_s);
  const auto topics = summarise(context.endpoints());
  if (common.json) {
    Json json = {{"domain", context.domain()}, {"topics", Json::array()}};
    for (const auto& [name, topic] : topics) {
      json["topics"].push_back({{"name", name},
                                {"types", topic.types},
                                {"publishers", topic.publishers},
                                {"subscribers", topic.subscribers}});
    }
    std::cout << to_line(json) << std::endl;
  } else {
    for (const auto& [name, topic] : topics) {
      std::cout << name << (with_types ? " [" + joined(topic.types) + "]" : "") << "\n";
    }
    std::cout << std::flush;
  }
  if (!topics.empty()) return 0;
  return say_nothing("no topic was found in domain " + std::to_string(context.domain()) +
                     ". Is something running, with the same ROS_DOMAIN_ID?");
}

std::vector<std::string> nodes_of(const std::string& participant,
                                  const std::vector<runtime::ParticipantInfo>& participants) {
  for (const auto& p : participants) {
    if (p.guid_prefix == participant) return p.nodes;
  }
  return {};
}

Json endpoint_json(const runtime::EndpointInfo& endpoint,
                   const std::vector<runtime::ParticipantInfo>& participants) {
  return {{"nodes", nodes_of(endpoint.participant, participants)},
          {"participant", endpoint.participant},
          {"type", endpoint.type},
          {"reliability", endpoint.reliable ? "reliable" : "best_effort"},
          {"durability", endpoint.transient_local ? "transient_local" : "volatile"}};
}

void print_endpoints(const Json& endpoints, const char* what) {
  std::cout << what << ": " << endpoints.size() << "\n";
  for (const auto& e : endpoints) {
    const auto nodes = joined(e["nodes"].get<std::vector<std::string>>());
    std::cout << "  " << (nodes.empty() ? "a process that names no node" : nodes) << "  ("
              << e["reliability"].get<std::string>() << ", " << e["durability"].get<std::string>()
              << ")\n";
  }
}

int info(const CommonOptions& common, const std::string& topic) {
  auto name = full_topic_name(topic);
  if (!name) return say_wrong_call(name.error().message);
  auto session = Session::open();
  if (!session) return say_wrong_call(session.error().message);
  auto& s = **session;
  if (!s.wait_for(common.timeout_s, [&] { return !s.endpoints_of(*name).empty(); })) {
    return s.say_no_topic(*name, common.timeout_s);
  }
  s.settle(common.timeout_s);
  const auto participants = s.context().participants();
  const auto endpoints = s.endpoints_of(*name);
  std::set<std::string> types;
  Json publishers = Json::array();
  Json subscribers = Json::array();
  for (const auto& endpoint : endpoints) {
    types.insert(endpoint.type);
    (endpoint.writer ? publishers : subscribers).push_back(endpoint_json(endpoint, participants));
  }
  if (common.json) {
    std::cout << to_line(Json{{"name", *name},
                              {"types", types},
                              {"publishers", publishers},
                              {"subscribers", subscribers}})
              << std::endl;
    return 0;
  }
  std::cout << "Topic: " << *name << "\nType: " << joined(types) << "\n";
  print_endpoints(publishers, "Publishers");
  print_endpoints(subscribers, "Subscribers");
  std::cout << std::flush;
  if (types.size() > 1) {
    std::cerr << "goshawk: this topic has several types: their endpoints do not hear each other"
              << std::endl;
  }
  return 0;
}

}  // namespace

Verb topic_list_verb() {
  return {"list", "the topics of the domain", [](CLI::App& app, CommonOptions& common) {
            auto with_types = std::make_shared<bool>(false);
            app.add_flag("-t,--show-types", *with_types, "with their types");
            return [&common, with_types] { return list(common, *with_types); };
          }};
}

Verb topic_info_verb() {
  return {"info", "who writes and reads a topic", [](CLI::App& app, CommonOptions& common) {
            auto topic = std::make_shared<std::string>();
            app.add_option("topic", *topic, "its name")->required();
            app.footer("Example:\n  goshawk topic info /map/voxels");
            return [&common, topic] { return info(common, *topic); };
          }};
}

}  // namespace goshawk::introspection
