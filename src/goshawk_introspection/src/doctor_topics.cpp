#include <algorithm>
#include <map>
#include <set>
#include <sstream>

#include "doctor.hpp"

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

// A reader that asks for more than a writer offers gets nothing from it, and no error either.
void check_pair(const Owners& names, const EndpointInfo& writer, const EndpointInfo& reader,
                std::vector<Finding>& findings) {
  std::string asks;
  if (reader.reliable && !writer.reliable) asks = "reliable, but best effort is offered";
  if (reader.transient_local && !writer.transient_local) {
    asks += std::string(asks.empty() ? "" : "; and ") + "latched, but volatile is offered";
  }
  if (asks.empty()) return;
  findings.push_back({"topic " + writer.topic, Level::fault,
                      who(names, reader) + " does not hear " + who(names, writer) +
                          ": it asks for " + asks +
                          ": let the reader ask for less, or the writer offer more"});
}

void check_types(const std::string& topic, const std::vector<EndpointInfo>& ends,
                 std::vector<Finding>& findings) {
  std::set<std::string> types;
  for (const auto& e : ends) types.insert(e.type);
  if (types.size() < 2) return;
  std::string list;
  for (const auto& type : types) list += (list.empty() ? "" : ", ") + type;
  findings.push_back({"topic " + topic, Level::fault,
                      "has several types, which do not hear each other: " + list +
                          ": give the topic one type, or one of them another name"});
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
  if (writers == 0 && readers > 0) {
    findings.push_back({"topic " + topic, Level::note,
                        "is read by " + who(names, ends.front()) + ", but nobody writes it"});
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
    findings.push_back({"node " + node, Level::warning,
                        std::to_string(n) +
                            " nodes have this name: start one of them with "
                            "another, as in goshawk run COMPONENT:NAME, or end the older one"});
  }
}

}  // namespace

std::vector<Finding> check_topics(const std::vector<ParticipantInfo>& participants,
                                  const std::vector<EndpointInfo>& endpoints) {
  std::vector<Finding> findings;
  check_node_names(participants, findings);
  std::map<std::string, std::vector<EndpointInfo>> topics;
  for (const auto& e : endpoints) topics[e.topic].push_back(e);
  const Owners names = names_of(participants);
  for (const auto& [topic, ends] : topics) check_topic(names, topic, ends, findings);
  return findings;
}

std::vector<int> domains_in_use(const std::string& udp_table) {
  // Unicast discovery of participant p in domain d listens at port 7400 + 250 d + 10 + 2 p.
  constexpr int kBase = 7400, kPerDomain = 250, kFirst = 10, kLast = 10 + 2 * 60;
  std::set<int> domains;
  std::istringstream lines(udp_table);
  std::string line;
  std::getline(lines, line);  // headings
  while (std::getline(lines, line)) {
    const auto colon = line.find(':', line.find(':') + 1);
    if (colon == std::string::npos) continue;
    const int port = int(std::strtol(line.substr(colon + 1, 4).c_str(), nullptr, 16));
    const int offset = (port - kBase) % kPerDomain;
    if (port < kBase || offset < kFirst || offset > kLast || offset % 2 != 0) continue;
    domains.insert((port - kBase) / kPerDomain);
  }
  return {domains.begin(), domains.end()};
}

}  // namespace goshawk::introspection
