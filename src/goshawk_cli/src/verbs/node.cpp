#include <fmt/format.h>

#include "goshawk/introspection/graph.hpp"
#include "verbs/verbs.hpp"

namespace goshawk::cli {
namespace {

int print_nodes(double timeout_s, const Console& console) {
  auto session = introspection::Session::open();
  if (!session) return console.failed(session.error());
  const auto [nodes, unnamed] = introspection::list_nodes(**session, timeout_s);
  const int domain = (*session)->context().domain();
  if (nodes.empty()) {
    return console.not_done(
        {ErrorCode::stage_silent,
         fmt::format("no node was found in domain {}{}", domain,
                     unnamed == 0 ? ". Is something running, with the same ROS_DOMAIN_ID?"
                                  : ", only processes that name none")});
  }
  Json json = {{"domain", domain}, {"nodes", Json::array()}};
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    json["nodes"].push_back({{"name", nodes[i].name}, {"process", nodes[i].process}});
    if (!console.json()) fmt::print("{}\n", nodes[i].name);
    if (i > 0 && nodes[i].name == nodes[i - 1].name) {
      console.say(fmt::format("two nodes are named {}", nodes[i].name));
    }
  }
  json["unnamed_participants"] = unnamed;
  if (console.json()) console.print_line(json);
  return kDone;
}

}  // namespace

void add_node(Program& program) {
  const Verb node = program.verb("node", "look at nodes");
  const Verb verb = node.word("list", "the nodes of the domain");
  auto timeout_s = std::make_shared<double>(2.0);
  add_timeout(verb, *timeout_s);
  verb.runs([timeout_s](const Console& console) { return print_nodes(*timeout_s, console); });
}

}  // namespace goshawk::cli
