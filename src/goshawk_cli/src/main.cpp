// goshawk VERB ...: the front door.

#include <algorithm>
#include <cstdio>

#include "goshawk/introspection/doctor_command.hpp"
#include "goshawk/introspection/node_command.hpp"
#include "goshawk/introspection/param_command.hpp"
#include "goshawk/introspection/topic_command.hpp"
#include "goshawk/recording/commands.hpp"
#include "goshawk/runtime/parameters.hpp"
#include "goshawk/runtime/version.hpp"
#include "verbs.hpp"

namespace {

using namespace goshawk;

struct Verb {
  const char* name;
  const char* what;
  int (*run)(const cli::Arguments&);
};

constexpr Verb kVerbs[] = {
    {"fly", "make or load a world, start every stage, fly it, judge it, draw it",
     &cli::fly_command},
    {"plan", "one plan in this process, no DDS: path, corridor, certified trajectory",
     &cli::plan_command},
    {"check", "the second opinion on a flight folder: what the body came near to, when and where",
     &cli::check_command},
    {"world", "make a world, or convert a map", &cli::world_command},
    {"campaign", "fly many random missions, judged, with a summary", &cli::campaign_command},
    {"launch", "start what a launch file lists, supervised, until Ctrl-C", &cli::launch_command},
    {"view", "look at a flight, or live with --live, in a browser", &cli::view_command},
    {"run", "start one component: goshawk run COMPONENT --ros-args ...", &cli::run_command},
    {"bench", "measure plans over DDS, or a stage beside its rivals", &cli::bench_command},
    {"conform", "examine a stage, whoever wrote it, item by item", &cli::conform_command},
    {"record", "record topics to an MCAP file, until Ctrl-C", &recording::record_command},
    {"replay", "play a recording over DDS, or list what is in it", &recording::replay_command},
    {"topic", "list, info, echo, hz, delay, bw, pub",
     [](const cli::Arguments& a) { return introspection::topic_command(a); }},
    {"node", "list", [](const cli::Arguments& a) { return introspection::node_command(a); }},
    {"param", "list, get, set, dump of a node that runs; describe COMPONENT",
     [](const cli::Arguments& a) { return introspection::param_command(a); }},
    {"doctor", "look at machine, settings and domain: what does not fit, and how to mend it",
     [](const cli::Arguments& a) { return introspection::doctor_command(a); }},
};

void print_help() {
  std::printf(
      "goshawk: plan and fly through clutter\n\nusage: goshawk VERB [...], and goshawk VERB "
      "--help for each\n\n");
  for (const Verb& verb : kVerbs) std::printf("  %-8s %s\n", verb.name, verb.what);
  std::printf(
      "\nA first quarter of an hour:\n"
      "  goshawk fly                  a flight through a made world; its folder is named at the "
      "end\n"
      "  goshawk view                 the same, to look at\n"
      "  goshawk launch flight        all stages, until Ctrl-C; in another terminal:\n"
      "  goshawk topic list           what they say to each other\n"
      "  goshawk param set /navigator v_max_m_s 1\n"
      "  goshawk doctor               where something does not work\n"
      "\nDDS domain: ROS_DOMAIN_ID (default 0). Interfaces: GOSHAWK_INTERFACES, loopback by "
      "default.\nExit status: 0 done, 1 not done (the code says why), 2 a wrong call.\n");
}

int unknown_verb(const std::string& name) {
  std::vector<std::string> names;
  for (const Verb& verb : kVerbs) names.emplace_back(verb.name);
  const std::string near = runtime::nearest_name(name, names);
  std::fprintf(stderr, "goshawk: there is no verb '%s'%s; goshawk --help lists them\n",
               name.c_str(), near.empty() ? "" : (", did you mean " + near + "?").c_str());
  return cli::kWrongCall;
}

}  // namespace

int main(int argc, char** argv) {
  cli::Arguments arguments(argv + 1, argv + argc);
  if (arguments.empty() || arguments[0] == "--help" || arguments[0] == "-h") {
    print_help();
    return arguments.empty() ? cli::kWrongCall : cli::kDone;
  }
  if (arguments[0] == "--version") {
    std::printf("goshawk %s\n", runtime::version().c_str());
    return cli::kDone;
  }
  const std::string name = arguments.front();
  arguments.erase(arguments.begin());
  const auto* verb = std::ranges::find_if(kVerbs, [&](const Verb& v) { return name == v.name; });
  if (verb == std::end(kVerbs)) return unknown_verb(name);
  try {
    return verb->run(arguments);
  } catch (const std::exception& bug) {
    std::fprintf(stderr, "goshawk %s: internal fault: %s\n", name.c_str(), bug.what());
    return cli::kNotDone;
  }
}
