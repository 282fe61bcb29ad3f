#include <fmt/format.h>

#include <algorithm>
#include <functional>

#include "goshawk/introspection/param_client.hpp"
#include "goshawk/runtime/component.hpp"
#include "verbs/verbs.hpp"

namespace goshawk::cli {
namespace {

using introspection::LiveParameter;
using introspection::ParameterVerb;
using introspection::Session;
using runtime::ParameterDescription;
using Assignments = std::vector<std::pair<std::string, std::string>>;

// A node answers between two requests, and a search may take its time.
constexpr double kTimeout_s = 10.0;

struct ParamOptions {
  std::string node;  // or component
  Words words;       // names, or names and values
  double timeout_s = kTimeout_s;
};

Json parameter_json(const ParameterDescription& p) {
  return {{"name", p.name},
          {"type", p.type},
          {"unit", p.unit},
          {"default", p.default_value},
          {"range", p.range},
          {"text", p.text},
          {"at_run_time", p.at_run_time}};
}

/// A string stands in quotes, so that '' and '12' are told from nothing and from a number.
std::string shown(const ParameterDescription& p, const std::string& value) {
  return p.type == "string" ? "'" + value + "'" : value;
}

std::string with_unit(const std::string& value, const std::string& unit) {
  return unit.empty() ? value : value + " " + unit;
}

void print_description(const ParameterDescription& p) {
  fmt::print("{} ({}{})\n  {}\n  default: {}\n", p.name, p.type,
             p.unit.empty() ? "" : ", " + p.unit, p.text, shown(p, p.default_value));
  if (!p.range.empty()) fmt::print("  range: {}\n", p.range);
  fmt::print("  takes effect at {}\n", p.at_run_time ? "run time" : "start only");
}

/// What is printed for people.
using Tell = std::function<void(const std::string& node, const std::vector<LiveParameter>&)>;

/// Asks a node, and tells what it answers.
int ask_node(const ParamOptions& o, ParameterVerb verb, const Assignments& parameters,
             const Console& console, const Tell& tell) {
  const auto name = introspection::full_topic_name(o.node);
  if (!name) {
    return console.wrong_call(
        {ErrorCode::invalid_parameter, fmt::format("'{}' is not the name of a node", o.node)});
  }
  auto session = Session::open();
  if (!session) return console.failed(session.error());
  const auto list = introspection::ask(**session, {*name, verb, parameters}, o.timeout_s);
  if (!list) return console.failed(list.error());
  if (!console.json()) {
    tell(*name, *list);
    if (list->empty() && verb == ParameterVerb::get) fmt::print("(no parameters)\n");
    return kDone;
  }
  Json json = {{"ok", true}, {"node", *name}, {"parameters", Json::array()}};
  for (const auto& p : *list) {
    json["parameters"].push_back(parameter_json(p.description));
    json["parameters"].back()["value"] = p.description.value;
    if (verb == ParameterVerb::set) json["parameters"].back()["old_value"] = p.old_value;
  }
  console.print_line(json);
  return kDone;
}

Assignments without_values(const Words& names) {
  Assignments list;
  for (const auto& name : names) list.emplace_back(name, "");
  return list;
}

int get_parameters(const ParamOptions& o, const Console& console) {
  return ask_node(o, ParameterVerb::get, without_values(o.words), console,
                  [&](const auto&, const auto& list) {
                    for (const auto& p : list) {
                      if (o.words.size() != 1) fmt::print("{}: ", p.description.name);
                      fmt::print("{}\n", p.description.value);
                    }
                  });
}

int list_components(const Console& console) {
  const auto names = runtime::installed_components();
  if (console.json()) {
    console.print_line({{"components", names}});
  } else {
    for (const auto& name : names) fmt::print("{}\n", name);
  }
  return kDone;
}

int list_parameters(const ParamOptions& o, const Console& console) {
  if (o.node.empty()) return list_components(console);
  return ask_node(o, ParameterVerb::get, {}, console, [](const auto&, const auto& list) {
    std::size_t names = 0, values = 0;
    for (const auto& [d, old] : list) {
      names = std::max(names, d.name.size());
      values = std::max(values, with_unit(shown(d, d.value), d.unit).size());
    }
    for (const auto& [d, old] : list) {
      const std::string value = with_unit(shown(d, d.value), d.unit);
      if (d.at_run_time) {
        fmt::print("{:<{}}  {}\n", d.name, names, value);
      } else {
        fmt::print("{:<{}}  {:<{}}  at start only\n", d.name, names, value, values);
      }
    }
  });
}

int set_parameters(const ParamOptions& o, const Console& console) {
  if (o.words.size() % 2 != 0) {
    return console.wrong_call(
        {ErrorCode::invalid_input,
         fmt::format("{} has no value: write NODE NAME VALUE, and more pairs of NAME VALUE to set "
                     "them all at once",
                     o.words.back())});
  }
  Assignments wanted;
  for (std::size_t i = 0; i < o.words.size(); i += 2) {
    wanted.emplace_back(o.words[i], o.words[i + 1]);
  }
  return ask_node(
      o, ParameterVerb::set, wanted, console, [](const std::string& name, const auto& list) {
        for (const auto& [d, old] : list) {
          fmt::print("{}: {} -> {}\n", d.name, shown(d, old), with_unit(shown(d, d.value), d.unit));
        }
        fmt::print("holds until the node ends; goshawk param dump {} keeps it\n", name);
      });
}

/// As a file for --params-file. JSON's quotes are YAML's too.
int dump_parameters(const ParamOptions& o, const Console& console) {
  return ask_node(
      o, ParameterVerb::get, {}, console, [](const std::string& name, const auto& list) {
        fmt::print("{}:\n  ros__parameters:{}\n", name, list.empty() ? " {}" : "");
        for (const auto& [d, old] : list) {
          fmt::print("    {}: {}\n", d.name, d.type == "string" ? to_line(Json(d.value)) : d.value);
        }
      });
}

/// Those of `chosen`, or all. @return invalid_parameter for a name that is not there
Result<std::vector<ParameterDescription>> only(const std::vector<ParameterDescription>& all,
                                               const Words& chosen, const std::string& component) {
  if (chosen.empty()) return all;
  std::vector<ParameterDescription> list;
  for (const auto& name : chosen) {
    const auto found = std::ranges::find(all, name, &ParameterDescription::name);
    if (found == all.end()) {
      Words known;
      for (const auto& p : all) known.push_back(p.name);
      const std::string near = runtime::nearest_name(name, known);
      return fail(ErrorCode::invalid_parameter,
                  fmt::format("{}: no such parameter of {}{}", name, component,
                              near.empty() ? "" : fmt::format("; did you mean {}?", near)));
    }
    list.push_back(*found);
  }
  return list;
}

int describe_component(const ParamOptions& o, const Console& console) {
  auto component = runtime::load_component(o.node);
  if (!component) return console.wrong_call(component.error());
  const auto parameters = only((*component)->describe(), o.words, o.node);
  if (!parameters) return console.wrong_call(parameters.error());
  if (console.json()) {
    Json json = {{"component", o.node}, {"parameters", Json::array()}};
    for (const auto& p : *parameters) json["parameters"].push_back(parameter_json(p));
    console.print_line(json);
    return kDone;
  }
  for (const auto& p : *parameters) print_description(p);
  if (parameters->empty()) fmt::print("(no parameters)\n");
  return kDone;
}

/// A leading '/' names a node that runs; a component is described without one.
int describe_parameters(const ParamOptions& o, const Console& console) {
  if (!o.node.starts_with('/')) return describe_component(o, console);
  return ask_node(o, ParameterVerb::get, without_values(o.words), console,
                  [](const auto&, const auto& list) {
                    for (const auto& p : list) {
                      print_description(p.description);
                      fmt::print("  now: {}\n", shown(p.description, p.description.value));
                    }
                  });
}

/// Parameters of the component that a node is probably one of, by its name.
std::vector<ParameterDescription> parameters_of(const std::string& node) {
  auto component = runtime::load_component(node.substr(node.rfind('/') + 1));
  return component ? (*component)->describe() : std::vector<ParameterDescription>();
}

Words parameter_names(const std::string& node, bool at_run_time_only) {
  Words names;
  for (const auto& p : parameters_of(node)) {
    if (p.at_run_time || !at_run_time_only) names.push_back(p.name);
  }
  return names;
}

/// The words that a parameter may be, if it is one of some.
Words parameter_values(const std::string& node, const std::string& name) {
  const auto all = parameters_of(node);
  const auto found = std::ranges::find(all, name, &ParameterDescription::name);
  if (found == all.end()) return {};
  if (found->type == "bool") return {"true", "false"};
  const std::string one_of = "one of ";
  if (!found->range.starts_with(one_of)) return {};
  Words values;
  for (std::size_t at = one_of.size(); at < found->range.size();) {
    const auto comma = std::min(found->range.find(", ", at), found->range.size());
    values.push_back(found->range.substr(at, comma - at));
    at = comma + 2;
  }
  return values;
}

Words complete_set(const Words& before) {
  if (before.size() % 2 == 1) return parameter_names(before.front(), true);
  return parameter_values(before.front(), before.back());
}

/// A verb on a node, and on what follows the node's name.
struct Description {
  const char* name;
  const char* summary;
  const char* node;  // what is said of the node
  bool node_required;
  const char* words;  // name of what follows, or nullptr
  const char* about_words;
  bool words_required;
  const char* examples;
  int (*run)(const ParamOptions&, const Console&);
  Completer complete_node;
  Completer complete_words;
};

void add_word(const Verb& param, const Description& d) {
  const Verb verb = param.word(d.name, d.summary);
  auto o = std::make_shared<ParamOptions>();
  auto* node = verb->add_option("node", o->node, d.node)->required(d.node_required);
  verb.completes(node, d.complete_node);
  if (d.words != nullptr) {
    auto* words = verb->add_option(d.words, o->words, d.about_words)->required(d.words_required);
    verb.completes(words, d.complete_words);
  }
  add_timeout(verb, o->timeout_s);
  verb->footer(d.examples);
  verb.runs([o, run = d.run](const Console& console) { return run(*o, console); });
}

}  // namespace

void add_param(Program& program) {
  const Verb param = program.verb("param", "parameters: of nodes that run, and of components");
  const char* node = "as goshawk node list shows it";
  const auto names = [](const Words& before) { return parameter_names(before.front(), false); };
  add_word(param, {"list",
                   "a node's parameters as they are; without a node, the installed components",
                   node,
                   false,
                   nullptr,
                   nullptr,
                   false,
                   "Examples:\n  goshawk param list\n  goshawk param list /navigator",
                   list_parameters,
                   node_names,
                   {}});
  add_word(param,
           {"get", "values as they are now", node, true, "name", "of parameters; none: all", false,
            "Examples:\n  goshawk param get /navigator v_max_m_s\n"
            "  goshawk param get /uav1/tracker --json",
            get_parameters, node_names, names});
  add_word(param, {"set", "change a node that runs", node, true, "assignments",
                   "NAME VALUE, and more of them; all are set at once, or none", true,
                   "Examples:\n  goshawk param set /navigator v_max_m_s 1 a_max_m_s2 0.8\n"
                   "  goshawk param set /path_search planner astar\n"
                   "goshawk param describe COMPONENT says what takes effect at run time.",
                   set_parameters, node_names, complete_set});
  add_word(param,
           {"describe", "parameters with unit, default, range, and whether they change at run time",
            "a component, as goshawk run takes it; or /NODE, which runs, with its values", true,
            "name", "of parameters; none: all", false,
            "Examples:\n  goshawk param describe tracker\n"
            "  goshawk param describe path_search planner z_weight\n"
            "  goshawk param describe /uav1/path_search",
            describe_parameters, component_names, names});
  add_word(param, {"dump",
                   "all values, as a file for --params-file",
                   node,
                   true,
                   nullptr,
                   nullptr,
                   false,
                   "Examples:\n  goshawk param dump /navigator > my.yaml\n"
                   "  goshawk launch flight --ros-args --params-file my.yaml",
                   dump_parameters,
                   node_names,
                   {}});
}

}  // namespace goshawk::cli
