#include "process.hpp"
#include "verbs/verbs.hpp"

namespace goshawk::cli {

void add_run(Program& program) {
  struct RunOptions {
    Words components;
    Words ros_args;
  };
  const Verb verb = program.verb("run", "start one component, or several in one process");
  auto o = std::make_shared<RunOptions>();
  auto* components =
      verb->add_option("COMPONENT", o->components, "COMPONENT[:NODE_NAME], one or several")
          ->required();
  verb.completes(components, component_names);
  verb.takes_ros_args(o->ros_args);
  verb->footer(
      "Runs until Ctrl-C. Behind --ros-args: -r from:=to, -p name:=value, --params-file FILE,\n"
      "--log-level LEVEL. goshawk param describe COMPONENT lists its parameters.\n\n"
      "Examples:\n"
      "  goshawk run path_search --ros-args -p planner:=astar\n"
      "  goshawk run path_search corridor_builder trajectory_optimizer --ros-args -r "
      "__ns:=/uav1\n"
      "  goshawk run tracker:my_tracker --ros-args --params-file my.yaml --log-level debug");
  verb.runs([o](const Console& console) {
    Words command{install_prefix() + "/bin/goshawk_container"};
    if (console.json()) command.emplace_back("--json");
    command.insert(command.end(), o->components.begin(), o->components.end());
    command.emplace_back("--ros-args");
    command.insert(command.end(), o->ros_args.begin(), o->ros_args.end());
    return become(command, console);
  });
}

}  // namespace goshawk::cli
