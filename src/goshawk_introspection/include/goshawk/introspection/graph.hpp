#pragma once

#include <map>
#include <set>
#include <string>
#include <vector>

#include "goshawk/introspection/session.hpp"

namespace goshawk::introspection {

struct NodeInfo {
  std::string name;     // full
  std::string process;  // name of its participant
};

/// The nodes of the domain, by name, and processes without named nodes.
struct NodeList {
  std::vector<NodeInfo> nodes;
  int unnamed_participants = 0;
};
NodeList list_nodes(Session& session, double timeout_s);

/// A node, and what its process writes and reads: DDS tells the process of a writer, not the node.
struct NodeDetails {
  std::string name;                                            // full
  std::string process;                                         // name of its participant
  std::vector<std::string> others;                             // nodes of the same process
  std::map<std::string, std::string> publishers, subscribers;  // topic to type
  std::map<std::string, std::string> services;  // that a process of ROS 2 serves, to type
};

/// @param name full, or without its leading '/'
/// @return invalid_parameter for what is not a name, stage_silent if the node does not appear
Result<NodeDetails> node_info(Session& session, const std::string& name, double timeout_s);

struct TopicSummary {
  std::set<std::string> types;
  int publishers = 0;
  int subscribers = 0;
};

/// The topics of the domain, by name.
std::map<std::string, TopicSummary> list_topics(Session& session, double timeout_s);

/// A writer or reader of a topic.
struct Endpoint {
  std::vector<std::string> nodes;  // of its process
  runtime::EndpointInfo info;
};

struct TopicInfo {
  std::string name;
  std::set<std::string> types;
  std::vector<Endpoint> publishers;
  std::vector<Endpoint> subscribers;
};

/// @return invalid_parameter or stage_silent if the topic does not appear within timeout_s
Result<TopicInfo> topic_info(Session& session, const std::string& topic, double timeout_s);

}  // namespace goshawk::introspection
