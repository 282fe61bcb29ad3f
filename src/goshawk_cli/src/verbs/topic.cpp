#include "verbs/topic.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "goshawk/introspection/graph.hpp"
#include "goshawk/introspection/schema.hpp"
#include "goshawk/introspection/services.hpp"

namespace goshawk::cli {
namespace {

using introspection::Endpoint;
using introspection::Session;
using introspection::TopicInfo;

int print_topics(double timeout_s, bool with_types, const Console& console) {
  auto session = Session::open();
  if (!session) return console.failed(session.error());
  const auto topics = introspection::list_topics(**session, timeout_s);
  const auto services = introspection::services_of((*session)->context().endpoints());
  const int domain = (*session)->context().domain();
  if (topics.empty() && services.empty()) {
    return console.not_done(
        {ErrorCode::stage_silent, fmt::format("no topic was found in domain {}. Is something "
                                              "running, with the same ROS_DOMAIN_ID?",
                                              domain)});
  }
  Json json = {{"domain", domain}, {"topics", Json::array()}, {"services", Json::array()}};
  const auto print_line = [&](const std::string& name, const std::set<std::string>& types) {
    if (console.json()) return;
    fmt::print("{}{}\n", name, with_types ? fmt::format(" [{}]", fmt::join(types, ", ")) : "");
  };
  for (const auto& [name, topic] : topics) {
    json["topics"].push_back({{"name", name},
                              {"types", topic.types},
                              {"publishers", topic.publishers},
                              {"subscribers", topic.subscribers}});
    print_line(name, topic.types);
  }
  for (const auto& [name, service] : services) {
    json["services"].push_back({{"name", name},
                                {"types", service.types},
                                {"servers", service.servers},
                                {"clients", service.clients}});
    print_line("service " + name, service.types);
  }
  if (console.json()) console.print_line(json);
  return kDone;
}

const char* reliability(const Endpoint& e) {
  return e.info.reliable ? "reliable" : "best_effort";
}

const char* durability(const Endpoint& e) {
  return e.info.transient_local ? "transient_local" : "volatile";
}

Json endpoints_json(const std::vector<Endpoint>& endpoints) {
  Json list = Json::array();
  for (const auto& e : endpoints) {
    list.push_back({{"nodes", e.nodes},
                    {"participant", e.info.participant},
                    {"type", e.info.type},
                    {"reliability", reliability(e)},
                    {"durability", durability(e)}});
  }
  return list;
}

void print_endpoints(const std::vector<Endpoint>& endpoints, const char* what, bool verbose) {
  fmt::print("{}: {}\n", what, endpoints.size());
  for (const auto& e : endpoints) {
    fmt::print("  {}  ({}, {})\n",
               e.nodes.empty() ? "a process that names no node"
                               : fmt::format("{}", fmt::join(e.nodes, ", ")),
               reliability(e), durability(e));
    if (verbose) fmt::print("    {}, of participant {}\n", e.info.type, e.info.participant);
  }
}

int print_topic(const std::string& topic, double timeout_s, bool verbose,
                const Console& console) {
  auto session = Session::open();
  if (!session) return console.failed(session.error());
  const auto info = introspection::topic_info(**session, topic, timeout_s);
  if (!info) return console.failed(info.error());
  if (console.json()) {
    console.print_line({{"name", info->name},
                        {"types", info->types},
                        {"publishers", endpoints_json(info->publishers)},
                        {"subscribers", endpoints_json(info->subscribers)}});
    return kDone;
  }
  fmt::print("Topic: {}\nType: {}\n", info->name, fmt::join(info->types, ", "));
  print_endpoints(info->publishers, "Publishers", verbose);
  print_endpoints(info->subscribers, "Subscribers", verbose);
  std::fflush(stdout);
  if (info->types.size() > 1) {
    console.say("this topic has several types: their endpoints do not hear each other");
  }
  return kDone;
}

int print_type(const std::string& topic, double timeout_s, const Console& console) {
  auto session = Session::open();
  if (!session) return console.failed(session.error());
  const auto info = introspection::topic_info(**session, topic, timeout_s);
  if (!info) return console.failed(info.error());
  if (console.json()) {
    console.print_line({{"name", info->name}, {"types", info->types}});
  } else {
    fmt::print("{}\n", fmt::join(info->types, "\n"));
  }
  return kDone;
}

int print_topics_of(const std::string& type, double timeout_s, const Console& console) {
  auto session = Session::open();
  if (!session) return console.failed(session.error());
  // Any type may be on the wire; one of ours may also be written in short.
  const auto known = introspection::find_type(type);
  const std::string name = known ? std::string((*known)->name) : type;
  Words found;
  for (const auto& [topic, summary] : introspection::list_topics(**session, timeout_s)) {
    if (summary.types.contains(name)) found.push_back(topic);
  }
  if (found.empty()) {
    if (!known) return console.wrong_call({ErrorCode::invalid_parameter, known.error().message});
    return console.not_done({ErrorCode::stage_silent,
                             fmt::format("no topic of domain {} has the type {}",
                                         (*session)->context().domain(), name)});
  }
  if (console.json()) {
    console.print_line({{"type", name}, {"topics", found}});
  } else {
    fmt::print("{}\n", fmt::join(found, "\n"));
  }
  return kDone;
}

}  // namespace

void add_timeout(const Verb& verb, double& timeout_s) {
  verb->add_option("--timeout", timeout_s, "[s] longest wait for something to be there")
      ->check(CLI::Range(0.0, 86400.0))
      ->capture_default_str();
}

void add_topic_list(const Verb& topic) {
  const Verb verb = topic.word("list", "the topics of the domain");
  struct Options {
    bool with_types = false;
    double timeout_s = 2.0;
  };
  auto o = std::make_shared<Options>();
  verb->add_flag("-t,--show-types", o->with_types, "with their types");
  add_timeout(verb, o->timeout_s);
  verb.runs([o](const Console& console) { return print_topics(o->timeout_s, o->with_types, console); });
}

void add_topic_info(const Verb& topic) {
  const Verb verb = topic.word("info", "who writes and reads a topic");
  struct Options {
    std::string topic;
    bool verbose = false;
    double timeout_s = 2.0;
  };
  auto o = std::make_shared<Options>();
  verb.completes(verb->add_option("topic", o->topic, "its name")->required(), topic_names);
  verb->add_flag("-v,--verbose", o->verbose, "with each one's type and process");
  add_timeout(verb, o->timeout_s);
  verb->footer("Example:\n  goshawk topic info /map/voxels -v");
  verb.runs([o](const Console& console) {
    return print_topic(o->topic, o->timeout_s, o->verbose, console);
  });
}

void add_topic_type(const Verb& topic) {
  const Verb verb = topic.word("type", "the type of a topic");
  struct Options {
    std::string topic;
    double timeout_s = 2.0;
  };
  auto o = std::make_shared<Options>();
  verb.completes(verb->add_option("topic", o->topic, "its name")->required(), topic_names);
  add_timeout(verb, o->timeout_s);
  verb->footer("Example:\n  goshawk topic type /odom");
  verb.runs([o](const Console& console) { return print_type(o->topic, o->timeout_s, console); });
}

void add_topic_find(const Verb& topic) {
  const Verb verb = topic.word("find", "the topics of a type");
  struct Options {
    std::string type;
    double timeout_s = 2.0;
  };
  auto o = std::make_shared<Options>();
  verb.completes(verb->add_option("type", o->type, "as goshawk_msgs/msg/Path")->required(),
                 type_names);
  add_timeout(verb, o->timeout_s);
  verb->footer("Example:\n  goshawk topic find nav_msgs/msg/Odometry");
  verb.runs([o](const Console& console) { return print_topics_of(o->type, o->timeout_s, console); });
}

void add_topic(Program& program) {
  const Verb topic = program.verb("topic", "look at topics, measure them, publish");
  add_topic_list(topic);
  add_topic_info(topic);
  add_topic_type(topic);
  add_topic_find(topic);
  add_topic_echo(topic);
  add_topic_meters(topic);
  add_topic_pub(topic);
}

}  // namespace goshawk::cli
