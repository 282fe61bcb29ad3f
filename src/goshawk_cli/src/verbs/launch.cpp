#include <fmt/format.h>

#include <filesystem>

#include "goshawk/runtime/parameters.hpp"
#include "process.hpp"
#include "values.hpp"
#include "verbs/verbs.hpp"

namespace goshawk::cli {
namespace {

namespace fs = std::filesystem;

struct LaunchOptions {
  std::string file;
  std::string host;
  std::string map;
  std::optional<Vec3> start_map;
  std::string log_dir;
  std::string secure;
  bool list = false;
  bool check = false;
  bool stop_with_parent = false;
  int parent = 0;  // its process id, if it is known
  Words ros_args;
};

int print_list(const Console& console) {
  const Words names = launch_files({});
  if (console.json()) {
    Json object = ok_json();
    object["launch_files"] = names;
    console.print(object);
  } else {
    for (const auto& name : names) fmt::print("{}\n", name);
  }
  return kDone;
}

/// A file, or the name of an installed one.
Result<std::string> find_file(const std::string& name) {
  std::error_code ignored;
  if (fs::is_regular_file(name, ignored)) return name;
  if (name.find('/') == std::string::npos) {
    const auto installed = fs::path(install_prefix()) / "share/goshawk/launch" /
                           (name.ends_with(".yaml") ? name : name + ".yaml");
    if (fs::is_regular_file(installed, ignored)) return installed.string();
    const std::string near = runtime::nearest_name(name, launch_files({}));
    return fail(ErrorCode::invalid_parameter,
                fmt::format("there is no launch file '{}'{} (goshawk launch --list shows the "
                            "installed ones)",
                            name, near.empty() ? "" : fmt::format("; did you mean {}?", near)));
  }
  return fail(ErrorCode::invalid_parameter,
              fmt::format("{} {}", name,
                          fs::exists(name, ignored) ? "is not a file" : "does not exist"));
}

int run_launch(const LaunchOptions& o, const Console& console) {
  if (o.list) return print_list(console);
  if (o.file.empty()) {
    return console.wrong_call({ErrorCode::invalid_input,
                               "a launch file is missing: name a file, or an installed one such as "
                               "flight (--list shows them)"});
  }
  const auto file = find_file(o.file);
  if (!file) return console.wrong_call(file.error());
  std::string log_dir = o.log_dir;
  if (log_dir.empty() && !o.check) {
    const auto made = make_log_folder(fs::path(*file).stem().string());
    if (!made) return console.not_done(made.error());
    log_dir = *made;
  }
  Json start = nullptr;
  if (o.start_map) {
    start = fmt::format("{},{},{}", o.start_map->x(), o.start_map->y(), o.start_map->z());
  }
  return become_helper("launch.py",
                       {{"file", *file},
                        {"host", o.host},
                        {"map", o.map},
                        {"start", start},
                        {"log_dir", log_dir},
                        {"secure", o.secure},
                        {"check", o.check},
                        {"stop_with_parent", o.stop_with_parent},
                        {"parent", o.parent},
                        {"ros_args", o.ros_args}},
                       console);
}

}  // namespace

void add_launch(Program& program) {
  const Verb verb =
      program.verb("launch", "start what a launch file lists, supervised, until Ctrl-C");
  auto o = std::make_shared<LaunchOptions>();
  auto* file =
      verb->add_option("file", o->file, "launch file, or the name of an installed one (flight)");
  verb.completes(file, [](const Words& before) {
    return before.empty() ? launch_files(before) : Words();
  });
  verb->add_option("--host", o->host,
                   "start only what the file's hosts give to this one (docs/hosts.md)");
  verb->add_option("--map", o->map, "map to fly in (default: the launch file's, else a made world)");
  add_point(verb, "--start", o->start_map,
            "[m] where the simulated vehicle begins (default with --map: a free place)");
  verb->add_option("--log-dir", o->log_dir,
                   "folder for the logs (default: a new one in ~/.local/state/goshawk/log)");
  verb->add_option("--secure", o->secure,
                   "folder of goshawk secure init: fly with DDS Security, each stage with its own "
                   "certificate");
  verb->add_flag("--list", o->list, "only print the names of the installed launch files");
  verb->add_flag("--check", o->check, "only check the launch file");
  verb->add_flag("--stop-with-parent", o->stop_with_parent,
                 "stop as on Ctrl-C when the process that started this one ends");
  verb->add_option("--parent", o->parent)->group("");
  verb.takes_ros_args(o->ros_args);
  verb->footer(
      "Options behind --ros-args go to every component; a parameter names its node.\n\n"
      "Examples:\n"
      "  goshawk launch flight\n"
      "  goshawk launch flight --map office.bt --start 1,1,1\n"
      "  goshawk launch flight_hosts --host vehicle\n"
      "  goshawk launch flight_container --log-dir logs --ros-args -p navigator:v_max_m_s:=1\n"
      "  goshawk launch --list");
  verb.runs([o](const Console& console) { return run_launch(*o, console); });
}

}  // namespace goshawk::cli
