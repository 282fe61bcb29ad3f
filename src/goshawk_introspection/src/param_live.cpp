#include "param_live.hpp"

#include <algorithm>
#include <iostream>
#include <nlohmann/json.hpp>

#include "param_client.hpp"
#include "text.hpp"

namespace goshawk::introspection {
namespace {

using Json = nlohmann::ordered_json;
using List = std::vector<LiveParameter>;

int exit_status(ErrorCode code) {
  return code == ErrorCode::invalid_parameter || code == ErrorCode::invalid_input ? kWrongCall
                                                                                  : kNothing;
}

int say(const CommonOptions& common, const Error& error) {
  if (common.json) {
    std::cout << to_line({{"ok", false},
                          {"code", std::string(to_string(error.code))},
                          {"message", error.message}})
              << std::endl;
  }
  std::cerr << "goshawk: " << error.message << std::endl;
  return exit_status(error.code);
}

// Asks, and hands the answer to `tell`; prints what goes wrong.
template <typename Tell>
int asked(const CommonOptions& common, const std::string& node, ParameterVerb verb,
          const std::vector<std::pair<std::string, std::string>>& parameters, Tell&& tell) {
  const auto name = full_topic_name(node);
  if (!name) return say(common, fail(ErrorCode::invalid_input, "no name of a node: " + node));
  auto session = Session::open();
  if (!session) return say(common, session.error());
  const auto list = ask(**session, {*name, verb, parameters}, common.timeout_s);
  if (!list) return say(common, list.error());
  if (common.json) {
    Json json = {{"ok", true}, {"node", *name}, {"parameters", Json::array()}};
    for (const auto& p : *list) {
      json["parameters"].push_back(to_json(p.description));
      json["parameters"].back()["value"] = p.description.value;
      if (verb == ParameterVerb::set) json["parameters"].back()["old_value"] = p.old_value;
    }
    std::cout << to_line(json) << std::endl;
  } else {
    tell(*name, *list);
    std::cout << std::flush;
  }
  return 0;
}

std::vector<std::pair<std::string, std::string>> without_values(
    const std::vector<std::string>& names) {
  std::vector<std::pair<std::string, std::string>> list;
  for (const auto& name : names) list.emplace_back(name, "");
  return list;
}

// A string stands in quotes, so that '' and '12' are told from nothing and from a number.
std::string shown(const runtime::ParameterDescription& p, const std::string& value) {
  return p.type == "string" ? "'" + value + "'" : value;
}

std::string padded(const std::string& text, std::size_t width) {
  return text + std::string(width > text.size() ? width - text.size() : 0, ' ');
}

}  // namespace

void print_description(const runtime::ParameterDescription& p) {
  std::cout << p.name << " (" << p.type << (p.unit.empty() ? "" : ", " + p.unit) << ")\n  "
            << p.text << "\n  default: " << shown(p, p.default_value) << "\n";
  if (!p.range.empty()) std::cout << "  range: " << p.range << "\n";
  std::cout << (p.at_run_time ? "  takes effect at run time\n" : "  takes effect at start only\n");
}

Json to_json(const runtime::ParameterDescription& p) {
  return {{"name", p.name},
          {"type", p.type},
          {"unit", p.unit},
          {"default", p.default_value},
          {"range", p.range},
          {"text", p.text},
          {"at_run_time", p.at_run_time}};
}

int get_parameters(const CommonOptions& common, const std::string& node,
                   const std::vector<std::string>& names) {
  return asked(common, node, ParameterVerb::get, without_values(names),
               [&](const auto&, const List& list) {
                 for (const auto& p : list) {
                   if (names.size() != 1) std::cout << p.description.name << ": ";
                   std::cout << p.description.value << "\n";
                 }
               });
}

int list_parameters(const CommonOptions& common, const std::string& node) {
  return asked(common, node, ParameterVerb::get, {}, [](const auto&, const List& list) {
    std::size_t names = 0, values = 0;
    for (const auto& p : list) {
      names = std::max(names, p.description.name.size());
      values = std::max(
          values, shown(p.description, p.description.value).size() + p.description.unit.size());
    }
    for (const auto& [d, old] : list) {
      const std::string value = shown(d, d.value) + (d.unit.empty() ? "" : " " + d.unit);
      std::cout << padded(d.name, names + 2)
                << (d.at_run_time ? value : padded(value, values + 3) + "at start only") << "\n";
    }
    if (list.empty()) std::cout << "(no parameters)\n";
  });
}

int describe_parameters(const CommonOptions& common, const std::string& node,
                        const std::vector<std::string>& names) {
  return asked(common, node, ParameterVerb::get, without_values(names),
               [](const auto&, const List& list) {
                 for (const auto& p : list) {
                   print_description(p.description);
                   std::cout << "  now: " << shown(p.description, p.description.value) << "\n";
                 }
                 if (list.empty()) std::cout << "(no parameters)\n";
               });
}

int set_parameters(const CommonOptions& common, const std::string& node,
                   const std::vector<std::string>& assignments) {
  if (assignments.size() % 2 != 0) {
    return say(common, fail(ErrorCode::invalid_input,
                            "param set: " + assignments.back() +
                                " has no value: write NODE NAME VALUE, and more pairs of NAME "
                                "VALUE to set them all at once"));
  }
  std::vector<std::pair<std::string, std::string>> wanted;
  for (std::size_t i = 0; i < assignments.size(); i += 2) {
    wanted.emplace_back(assignments[i], assignments[i + 1]);
  }
  return asked(
      common, node, ParameterVerb::set, wanted, [](const std::string& name, const List& list) {
        for (const auto& [d, old] : list) {
          std::cout << d.name << ": " << shown(d, old) << " -> " << shown(d, d.value)
                    << (d.unit.empty() ? "" : " " + d.unit) << "\n";
        }
        std::cout << "holds until the node ends; goshawk param dump " << name << " keeps it\n";
      });
}

int dump_parameters(const CommonOptions& common, const std::string& node) {
  return asked(common, node, ParameterVerb::get, {}, [](const std::string& name, const List& list) {
    std::cout << name << ":\n  ros__parameters:" << (list.empty() ? " {}" : "") << "\n";
    for (const auto& [d, old] : list) {
      // JSON's quotes are YAML's too.
      std::cout << "    " << d.name << ": "
                << (d.type == "string" ? to_line(Json(d.value)) : d.value) << "\n";
    }
  });
}

}  // namespace goshawk::introspection
