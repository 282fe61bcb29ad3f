#include "goshawk/introspection/param_command.hpp"

#include <iostream>

#include "goshawk/runtime/component.hpp"
#include "session.hpp"
#include "text.hpp"

namespace goshawk::introspection {
namespace {

using Json = nlohmann::ordered_json;

void print(const std::vector<runtime::ParameterDescription>& parameters) {
  for (const auto& p : parameters) {
    std::cout << p.name << " (" << p.type << (p.unit.empty() ? "" : ", " + p.unit) << ")\n  "
              << p.text << "\n  default: "
              << (p.type == "string" ? "'" + p.default_value + "'" : p.default_value) << "\n";
    if (!p.range.empty()) std::cout << "  range: " << p.range << "\n";
  }
  if (parameters.empty()) std::cout << "(no parameters)\n";
  std::cout << std::flush;
}

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

int describe_component(const CommonOptions& common, const std::string& name) {
  auto component = runtime::load_component(name);
  if (!component) return say_wrong_call(component.error().message);
  const auto parameters = (*component)->describe();
  if (!common.json) {
    print(parameters);
    return 0;
  }
  Json json = {{"component", name}, {"parameters", Json::array()}};
  for (const auto& p : parameters) {
    json["parameters"].push_back({{"name", p.name},
                                  {"type", p.type},
                                  {"unit", p.unit},
                                  {"default", p.default_value},
                                  {"range", p.range},
                                  {"text", p.text}});
  }
  std::cout << to_line(json) << std::endl;
  return 0;
}

}  // namespace

int param_command(std::vector<std::string> arguments) {
  static const std::vector<Verb> kVerbs = {
      {"list", "the installed components",
       [](CLI::App&, CommonOptions& common) {
         return [&common] { return list_components(common); };
       }},
      {"describe", "the parameters of a component", [](CLI::App& app, CommonOptions& common) {
         auto name = std::make_shared<std::string>();
         app.add_option("component", *name, "its name, as goshawk run takes it")->required();
         return [&common, name] { return describe_component(common, *name); };
       }}};
  return run_verb("param", kVerbs, std::move(arguments));
}

}  // namespace goshawk::introspection
