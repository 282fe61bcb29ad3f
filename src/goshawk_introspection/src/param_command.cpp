#include "goshawk/introspection/param_command.hpp"

#include <algorithm>
#include <iostream>
#include <nlohmann/json.hpp>

#include "goshawk/runtime/component.hpp"
#include "param_live.hpp"
#include "text.hpp"

namespace goshawk::introspection {
namespace {

// A node answers between two requests, and a search may take its time.
constexpr double kTimeout_s = 10.0;

using Json = nlohmann::ordered_json;
using Names = std::vector<std::string>;

int list_components(const CommonOptions& common) {
  const auto names = runtime::installed_components();
  if (common.json) {
    std::cout << to_line({{"components", names}}) << std::endl;
    return 0;
  }
  for (const auto& name : names) std::cout << name << "\n";
  std::cout << std::flush;
  return 0;
}

// Those of `chosen`, or all. @return invalid_parameter for a name that is not there
Result<std::vector<runtime::ParameterDescription>> only(
    std::vector<runtime::ParameterDescription> all, const Names& chosen,
    const std::string& component) {
  if (chosen.empty()) return all;
  Names known;
  for (const auto& p : all) known.push_back(p.name);
  std::vector<runtime::ParameterDescription> list;
  for (const auto& name : chosen) {
    const auto found = std::ranges::find(known, name);
    if (found != known.end()) {
      list.push_back(all[std::size_t(found - known.begin())]);
      continue;
    }
    const std::string near = runtime::nearest_name(name, known);
    return fail(ErrorCode::invalid_parameter,
                name + ": no such parameter of " + component +
                    (near.empty() ? "" : "; did you mean " + near + "?"));
  }
  return list;
}

int describe_component(const CommonOptions& common, const std::string& name, const Names& chosen) {
  auto component = runtime::load_component(name);
  if (!component) return say_wrong_call(component.error().message);
  const auto parameters = only((*component)->describe(), chosen, name);
  if (!parameters) return say_wrong_call(parameters.error().message);
  if (common.json) {
    Json json = {{"component", name}, {"parameters", Json::array()}};
    for (const auto& p : *parameters) json["parameters"].push_back(to_json(p));
    std::cout << to_line(json) << std::endl;
    return 0;
  }
  for (const auto& p : *parameters) print_description(p);
  if (parameters->empty()) std::cout << "(no parameters)\n";
  std::cout << std::flush;
  return 0;
}

// A leading '/' names a node that runs; a component is described without one.
int describe(const CommonOptions& common, const std::string& name, const Names& chosen) {
  if (name.starts_with('/')) return describe_parameters(common, name, chosen);
  return describe_component(common, name, chosen);
}

// A verb on a node, and on what follows the node's name.
Verb verb(const std::string& name, const std::string& summary, const std::string& examples,
          const std::string& rest, const std::string& about_rest, std::size_t least_rest,
          int (*run)(const CommonOptions&, const std::string&, const Names&)) {
  return {name, summary,
          [=](CLI::App& app, CommonOptions& common) {
            auto node = std::make_shared<std::string>();
            auto names = std::make_shared<Names>();
            app.add_option("node", *node, "as goshawk node list shows it")->required();
            if (!rest.empty()) {
              auto* option = app.add_option(rest, *names, about_rest);
              if (least_rest > 0) option->required()->expected(int(least_rest), 1000);
            }
            app.footer("Examples:\n" + examples);
            return [&common, node, names, run] { return run(common, *node, *names); };
          },
          kTimeout_s};
}

Verb list_verb() {
  return {"list", "a node's parameters as they are; without a node, the installed components",
          [](CLI::App& app, CommonOptions& common) {
            auto node = std::make_shared<std::string>();
            app.add_option("node", *node, "as goshawk node list shows it");
            app.footer("Examples:\n  goshawk param list\n  goshawk param list /navigator");
            return [&common, node] {
              return node->empty() ? list_components(common) : list_parameters(common, *node);
            };
          },
          kTimeout_s};
}

Verb describe_verb() {
  return {"describe", "parameters with unit, default, range, and whether they change at run time",
          [](CLI::App& app, CommonOptions& common) {
            auto name = std::make_shared<std::string>();
            auto names = std::make_shared<Names>();
            app.add_option("component", *name,
                           "as goshawk run takes it; or /NODE, which runs, with its values")
                ->required();
            app.add_option("name", *names, "of parameters; none: all");
            app.footer(
                "Examples:\n  goshawk param describe tracker\n"
                "  goshawk param describe path_search planner z_weight\n"
                "  goshawk param describe /uav1/path_search");
            return [&common, name, names] { return describe(common, *name, *names); };
          },
          kTimeout_s};
}

}  // namespace

int param_command(std::vector<std::string> arguments) {
  static const std::vector<Verb> kVerbs = {
      list_verb(),
      verb("get", "values as they are now: param get NODE [NAME ...]",
           "  goshawk param get /navigator v_max_m_s\n  goshawk param get /uav1/tracker --json",
           "name", "of parameters; none: all", 0, &get_parameters),
      verb("set", "changes a node that runs: param set NODE NAME VALUE [NAME VALUE ...]",
           "  goshawk param set /navigator v_max_m_s 1 a_max_m_s2 0.8\n"
           "  goshawk param set /path_search planner astar\n"
           "goshawk param describe COMPONENT says what takes effect at run time.",
           "assignments", "NAME VALUE, and more of them; all are set at once, or none", 1,
           &set_parameters),
      describe_verb(),
      verb("dump", "all values, as a file for --params-file",
           "  goshawk param dump /navigator > my.yaml\n"
           "  goshawk launch flight --ros-args --params-file my.yaml",
           "", "", 0, [](const CommonOptions& common, const std::string& node, const Names&) {
             return dump_parameters(common, node);
           })};
  return run_verb("param", kVerbs, std::move(arguments));
}

}  // namespace goshawk::introspection
