#include "goshawk/introspection/node_command.hpp"

#include <algorithm>
#include <iostream>

#include "session.hpp"
#include "text.hpp"

namespace goshawk::introspection {
namespace {

using Json = nlohmann::ordered_json;

int list(const CommonOptions& common) {
  auto session = Session::open();
  if (!session) return say_wrong_call(session.error().message);
  auto& context = (*session)->context();
  (*session)->settle(common.timeout_s);
  std::vector<std::pair<std::string, std::string>> nodes;  // name, process
  int unnamed = 0;
  for (const auto& participant : context.participants()) {
    for (const auto& name : participant.nodes) nodes.emplace_back(name, participant.name);
    if (participant.nodes.empty()) ++unnamed;
  }
  std::ranges::sort(nodes);
  if (common.json) {
    Json json = {{"domain", context.domain()}, {"nodes", Json::array()}};
    for (const auto& [name, process] : nodes) {
      json["nodes"].push_back({{"name", name}, {"process", process}});
    }
    json["unnamed_participants"] = unnamed;
    std::cout << to_line(json) << std::endl;
  } else {
    for (const auto& [name, process] : nodes) std::cout << name << "\n";
    std::cout << std::flush;
  }
  for (std::size_t i = 1; i < nodes.size(); ++i) {
    if (nodes[i].first == nodes[i - 1].first) {
      std::cerr << "goshawk: two nodes are named " << nodes[i].first << std::endl;
    }
  }
  if (!nodes.empty()) return 0;
  return say_nothing("no node was found in domain " + std::to_string(context.domain()) +
                     (unnamed == 0 ? ". Is something running, with the same ROS_DOMAIN_ID?"
                                   : ", only processes that name none"));
}

}  // namespace

int node_command(std::vector<std::string> arguments) {
  static const std::vector<Verb> kVerbs = {
      {"list", "the nodes of the domain",
       [](CLI::App&, CommonOptions& common) { return [&common] { return list(common); }; }}};
  return run_verb("node", kVerbs, std::move(arguments));
}

}  // namespace goshawk::introspection
