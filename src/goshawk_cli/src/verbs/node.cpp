#include <fmt/format.h>
#include <fmt/ranges.h>

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

Json topics_json(const std::map<std::string, std::string>& topics) {
  Json list = Json::array();
  for (const auto& [name, type] : topics) list.push_back({{"name", name}, {"type", type}});
  return list;
}

void print_named(const char* what, const std::map<std::string, std::string>& topics) {
  fmt::print("{}: {}\n", what, topics.size());
  for (const auto& [name, type] : topics) fmt::print("  {}  [{}]\n", name, type);
}

int print_node(const std::string& name, double timeout_s, const Console& console) {
  auto session = introspection::Session::open();
  if (!session) return console.failed(session.error());
  const auto node = introspection::node_info(**session, name, timeout_s);
  if (!node) return console.failed(node.error());
  if (console.json()) {
    console.print_line({{"name", node->name},
                        {"process", node->process},
                        {"others", node->others},
                        {"publishers", topics_json(node->publishers)},
                        {"subscribers", topics_json(node->subscribers)},
                        {"services", topics_json(node->services)}});
    return kDone;
  }
  fmt::print("Node: {}\nProcess: {}\n", node->name, node->process);
  if (!node->others.empty()) {
    fmt::print("In the same process, so that their topics are among these: {}\n",
               fmt::join(node->others, ", "));
  }
  print_named("Publishers", node->publishers);
  print_named("Subscribers", node->subscribers);
  if (!node->services.empty()) print_named("Services", node->services);
  return kDone;
}

void add_node_info(const Verb& node) {
  const Verb verb = node.word("info", "what a node writes and reads");
  struct Options {
    std::string name;
    double timeout_s = 2.0;
  };
  auto o = std::make_shared<Options>();
  verb.completes(verb->add_option("node", o->name, "its name")->required(), node_names);
  add_timeout(verb, o->timeout_s);
  verb->footer("Example:\n  goshawk node info /navigator");
  verb.runs([o](const Console& console) { return print_node(o->name, o->timeout_s, console); });
}

}  // namespace

void add_node(Program& program) {
  const Verb node = program.verb("node", "look at nodes");
  const Verb verb = node.word("list", "the nodes of the domain");
  auto timeout_s = std::make_shared<double>(2.0);
  add_timeout(verb, *timeout_s);
  verb.runs([timeout_s](const Console& console) { return print_nodes(*timeout_s, console); });
  add_node_info(node);
}

}  // namespace goshawk::cli
