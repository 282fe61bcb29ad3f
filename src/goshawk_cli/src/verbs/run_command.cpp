#include <cstdio>

#include "folders.hpp"
#include "verbs.hpp"

namespace goshawk::cli {
namespace {

constexpr const char* kRunHelp =
    "usage: goshawk run COMPONENT[:NODE_NAME] ... [--ros-args -r from:=to -p name:=value\n"
    "                   --params-file FILE --log-level LEVEL]\n\n"
    "Starts one component, or several in one process, until Ctrl-C.\n"
    "goshawk param describe COMPONENT lists its parameters.\n\n"
    "Examples:\n"
    "  goshawk run path_search --ros-args -p planner:=astar\n"
    "  goshawk run path_search corridor_builder trajectory_optimizer --ros-args -r __ns:=/uav1\n"
    "  goshawk run tracker:my_tracker --ros-args --params-file my.yaml --log-level debug\n";

// Becomes a script of ours. @return only where that fails
int become_script(const std::string& name, const Arguments& arguments) {
  Arguments command{"/usr/bin/python3", install_prefix() + "/lib/goshawk/" + name, "--prefix",
                    install_prefix()};
  command.insert(command.end(), arguments.begin(), arguments.end());
  return become(command);
}

}  // namespace

int run_command(const Arguments& arguments) {
  if (arguments.empty() || arguments[0] == "--help" || arguments[0] == "-h") {
    std::fputs(kRunHelp, arguments.empty() ? stderr : stdout);
    return arguments.empty() ? kWrongCall : kDone;
  }
  Arguments command{install_prefix() + "/bin/goshawk_container"};
  command.insert(command.end(), arguments.begin(), arguments.end());
  return become(command);
}

int campaign_command(const Arguments& arguments) {
  return become_script("campaign.py", arguments);
}

int launch_command(const Arguments& arguments) {
  return become_script("launch.py", arguments);
}

int view_command(const Arguments& arguments) {
  return become_script("view.py", arguments);
}

}  // namespace goshawk::cli
