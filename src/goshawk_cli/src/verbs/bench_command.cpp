#include <algorithm>
#include <cstdio>
#include <filesystem>

#include "folders.hpp"
#include "goshawk/runtime/parameters.hpp"
#include "verbs.hpp"

namespace goshawk::cli {
namespace {

struct Bench {
  const char* name;
  const char* what;
};

constexpr const char* kPlan = "plan";

/// All but the first are programs of goshawk_benchmarks, bench_NAME.
constexpr Bench kBenches[] = {
    {kPlan, "latency of whole plans over DDS, by stage"},
    {"stage",
     "STAGE --input RECORDING: one stage on recorded inputs, in a process and in one, beside "
     "another's"},
    {"dds", "the middleware alone, by transport and size; setpoints beside large maps"},
    {"search", "grid searches beside a plain A*: time, nodes, length, set-up, growth"},
    {"scenario", "MAP.3dmap SCEN.3dscen: lengths and times on public voxel problems"},
    {"corridor", "corridor generators: time, volume, faces, obstacles cut"},
    {"trajectory", "planners: durations, speeds, optimisation and whole plans"},
    {"tracking", "closed-loop flights: errors by controller, weather and plant, step times"},
};

void print_help(std::FILE* out) {
  std::fputs(
      "Measure.\n\nusage: goshawk bench NAME [...], and goshawk bench NAME --help for each\n\n",
      out);
  for (const Bench& b : kBenches) std::fprintf(out, "  %-11s %s\n", b.name, b.what);
}

int unknown(const std::string& name) {
  std::vector<std::string> names;
  for (const Bench& b : kBenches) names.emplace_back(b.name);
  const std::string near = runtime::nearest_name(name, names);
  std::fprintf(stderr, "goshawk bench: there is no '%s'%s; goshawk bench --help lists them\n",
               name.c_str(), near.empty() ? "" : (", did you mean " + near + "?").c_str());
  return kWrongCall;
}

int run_program(const std::string& name, const Arguments& rest) {
  Arguments command{install_prefix() + "/lib/goshawk/bench_" + name};
  if (!std::filesystem::exists(command[0])) {
    std::fprintf(stderr,
                 "goshawk bench: bench_%s is not built: build with the tests, with tools/build\n",
                 name.c_str());
    return kNotDone;
  }
  command.insert(command.end(), rest.begin(), rest.end());
  return become(command);
}

}  // namespace

int bench_command(const Arguments& arguments) {
  const std::string name = arguments.empty() ? "" : arguments[0];
  if (name.empty() || name == "--help" || name == "-h") {
    print_help(name.empty() ? stderr : stdout);
    return name.empty() ? kWrongCall : kDone;
  }
  if (std::ranges::none_of(kBenches, [&](const Bench& b) { return b.name == name; })) {
    return unknown(name);
  }
  const Arguments rest(arguments.begin() + 1, arguments.end());
  return name == kPlan ? bench_plan_command(rest) : run_program(name, rest);
}

}  // namespace goshawk::cli
