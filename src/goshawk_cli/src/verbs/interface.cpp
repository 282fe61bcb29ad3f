#include <fmt/format.h>

#include "goshawk/introspection/schema.hpp"
#include "verbs/verbs.hpp"

namespace goshawk::cli {
namespace {

int print_interfaces(const Console& console) {
  const Words names = type_names({});
  if (console.json()) {
    Json object = ok_json();
    object["types"] = names;
    console.print(object);
  } else {
    for (const auto& name : names) fmt::print("{}\n", name);
  }
  return kDone;
}

int print_interface(const std::string& name, const Console& console) {
  const auto type = introspection::find_type(name);
  if (!type) return console.wrong_call({ErrorCode::invalid_parameter, type.error().message});
  const std::string definition = introspection::ros_msg_definition(**type);
  if (console.json()) {
    Json object = ok_json();
    object["type"] = std::string((*type)->name);
    object["definition"] = definition;
    console.print(object);
  } else {
    fmt::print("{}", definition);
  }
  return kDone;
}

}  // namespace

void add_interface(Program& program) {
  const Verb interface = program.verb("interface", "the types of messages");
  const Verb list = interface.word("list", "all types that idl/ has");
  list.runs([](const Console& console) { return print_interfaces(console); });
  const Verb show = interface.word("show", "a type's fields, with their units, as a .msg file");
  auto name = std::make_shared<std::string>();
  show.completes(show->add_option("type", *name, "as goshawk_msgs/msg/Path")->required(),
                 type_names);
  show->footer("Example:\n  goshawk interface show goshawk_msgs/msg/PlanRequest");
  show.runs([name](const Console& console) { return print_interface(*name, console); });
}

}  // namespace goshawk::cli
