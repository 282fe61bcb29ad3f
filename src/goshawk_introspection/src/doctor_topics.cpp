#include <algorithm>
#include <map>
#include <set>

#include "goshawk/introspection/doctor.hpp"
#include "goshawk/introspection/services.hpp"
#include "goshawk/runtime/version.hpp"

namespace goshawk::introspection {
namespace {

using runtime::EndpointInfo;
using runtime::ParticipantInfo;

using Owners = std::map<std::string, std::string>;  // participant: who that is

Owners names_of(const std::vector<ParticipantInfo>& participants) {
  Owners names;
  for (const auto& p : participants) {
    std::string& name = names[p.guid_prefix];
    for (const auto& node : p.nodes) name += (name.empty() ? "" : ", ") + node;
    if (name.empty()) name = p.name.empty() ? "an unnamed process" : p.name;
  }
  return names;
}

std::string who(const Owners& names, const EndpointInfo& e) {
  const auto found = names.find(e.participant);
  return found == names.end() ? "an unnamed process" : found->second;
}

// A reader that asks for more than a writer offers gets nothing from it, without an error.
void check_pair(const Owners& names, const EndpointInfo& writer, const EndpointInfo& reader,
                std::vector<Finding>& findings) {
  std::string asks;
  if (reader.reliable && !writer.reliable) asks = "reliable, but best effort is offered";
  if (reader.transient_local && !writer.transient_local) {
    asks += std::string(asks.empty() ? "" : "; and ") + "latched, but volatile is offered";
  }
  if (asks.empty()) return;
  findings.push_back(
      {"topic " + writer.topic, Level::fault,
       who(names, reader) + " gets nothing from " + who(names, writer) + ": it asks for " + asks,
       "a reader that asks for more than is offered gets nothing, without an error",
       "let the reader ask for less, or the writer offer more"});
}

void check_types(const std::string& topic, const std::vector<EndpointInfo>& ends,
                 std::vector<Finding>& findings) {
  std::set<std::string> types;
  for (const auto& e : ends) types.insert(e.type);
  if (types.size() < 2) return;
  std::string list;
  for (const auto& type : types) list += (list.empty() ? "" : ", ") + type;
  findings.push_back({"topic " + topic, Level::fault, "has several types: " + list,
                      "nodes with different types do not hear each other",
                      "use one type, or rename one of the topics (-r from:=to)"});
}

void check_topic(const Owners& names, const std::string& topic,
                 const std::vector<EndpointInfo>& ends, std::vector<Finding>& findings) {
  const std::size_t before = findings.size();
  check_types(topic, ends, findings);
  int writers = 0;
  int readers = 0;
  for (const auto& writer : ends) {
    if (!writer.writer) {
      ++readers;
      continue;
    }
    ++writers;
    for (const auto& reader : ends) {
      if (!reader.writer && reader.type == writer.type) check_pair(names, writer, reader, findings);
    }
  }
  if (findings.size() > before) return;
  // Clients come and go.
  if (writers == 0 && readers > 0 && topic != "/parameter_request") {
    std::set<std::string> all;
    for (const auto& e : ends) all.insert(who(names, e));
    std::string list;
    for (const auto& name : all) list += (list.empty() ? "" : ", ") + name;
    findings.push_back({"topic " + topic, Level::note,
                        "is read by " + list + ", but nobody writes it", "that stage waits for it",
                        "start who writes it, if it is wanted"});
  }
}

void check_node_names(const std::vector<ParticipantInfo>& participants,
                      std::vector<Finding>& findings) {
  std::map<std::string, int> count;
  for (const auto& p : participants) {
    for (const auto& node : p.nodes) ++count[node];
  }
  for (const auto& [node, n] : count) {
    if (n < 2) continue;
    findings.push_back({"node " + node, Level::warning, std::to_string(n) + " nodes have this name",
                        "each answers every request, and the others take the first answer",
                        "start one of them with another, as in goshawk run COMPONENT:NAME, or end "
                        "the older one"});
  }
}

void check_same_version(const Owners& names, const std::vector<ParticipantInfo>& participants,
                        std::vector<Finding>& findings) {
  std::map<std::string, std::string> who_has;  // by version; this program's own among them
  who_has[runtime::version()] = "this program";
  for (const auto& p : participants) {
    if (p.version.empty()) continue;  // another program of DDS
    std::string& list = who_has[p.version];
    list += (list.empty() ? "" : ", ") + names.at(p.guid_prefix);
  }
  if (who_has.size() < 2) return;
  std::string text;
  for (const auto& [version, list] : who_has) {
    text += (text.empty() ? "" : "; ") + version + ": " + list;
  }
  findings.push_back({"versions in the domain", Level::warning, text,
                      "before 1.0 a minor version may change messages, and those are not heard",
                      "install one version everywhere, and start again what is older"});
}

}  // namespace

std::vector<Finding> check_topics(const std::vector<ParticipantInfo>& participants,
                                  const std::vector<EndpointInfo>& endpoints) {
  std::vector<Finding> findings;
  check_node_names(participants, findings);
  std::map<std::string, std::vector<EndpointInfo>> topics;
  for (const auto& e : endpoints) {
    if (!service_end(e)) topics[e.topic].push_back(e);
  }
  const Owners names = names_of(participants);
  check_same_version(names, participants, findings);
  const auto of_ros = [&](const EndpointInfo& e) {
    const auto at = std::ranges::find(participants, e.participant, &ParticipantInfo::guid_prefix);
    return at != participants.end() && at->is_ros;
  };
  for (const auto& [topic, ends] : topics) {
    // What only programs of ROS 2 use is theirs.
    if (!std::ranges::all_of(ends, of_ros)) check_topic(names, topic, ends, findings);
  }
  return findings;
}

Finding check_refused(const std::string& node, std::uint64_t count, const std::string& message) {
  return {
      "node " + node, Level::warning, message,
      count == 1 ? "somebody sent what is no message of DDS, or in another's name"
                 : "somebody sends what are no messages of DDS, or in another's name",
      "find the program at that address and port (ss -unp); on a network, close the ports of DDS "
      "to others, or use DDS Security (docs/security.md)"};
}

}  // namespace goshawk::introspection
