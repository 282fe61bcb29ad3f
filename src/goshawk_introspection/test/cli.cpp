// introspection_cli topic|node|param|doctor ...

#include "goshawk/introspection/doctor_command.hpp"
#include "goshawk/introspection/node_command.hpp"
#include "goshawk/introspection/param_command.hpp"
#include "goshawk/introspection/topic_command.hpp"

int main(int argc, char** argv) {
  using namespace goshawk::introspection;
  std::vector<std::string> arguments(argv + 1, argv + argc);
  const std::string command = arguments.empty() ? "" : arguments.front();
  if (!arguments.empty()) arguments.erase(arguments.begin());
  if (command == "topic") return topic_command(std::move(arguments));
  if (command == "node") return node_command(std::move(arguments));
  if (command == "param") return param_command(std::move(arguments));
  if (command == "doctor") return doctor_command(std::move(arguments));
  return 3;
}
