// goshawk VERB ...: the command line.

#include <fmt/format.h>

#include "goshawk/runtime/version.hpp"
#include "verbs/verbs.hpp"

namespace {

using namespace goshawk::cli;

constexpr const char* kFooter =
    "A first quarter of an hour:\n"
    "  goshawk fly                  a flight through a made world; its folder is named at the end\n"
    "  goshawk view                 look at it\n"
    "  goshawk launch flight        all stages, until Ctrl-C; in another terminal:\n"
    "  goshawk goto 3,8,2           fly there\n"
    "  goshawk hold                 stop\n"
    "  goshawk topic list           what they say to each other\n"
    "  goshawk param set /navigator v_max_m_s 1\n"
    "  goshawk doctor               if something does not work\n"
    "\n"
    "goshawk help VERB, or goshawk VERB --help, tells more.\n"
    "DDS domain: ROS_DOMAIN_ID (default 0). Interfaces: GOSHAWK_INTERFACES, loopback by default.\n"
    "Exit status: 0 done, 1 not done (the code says why), 2 a wrong call.";

void add_help(Program& program) {
  const Verb verb = program.verb("help", "the help of a verb");
  auto words = std::make_shared<Words>();
  auto* option = verb->add_option("verb", *words, "as in goshawk help topic echo");
  verb.completes(option, [&program](const Words& before) {
    Words line = before;
    line.emplace_back();
    return program.complete(line);
  });
  verb.runs([&program, words](const Console&) { return program.help(*words); });
}

void describe(Program& program) {
  program.app().set_version_flag("--version", "goshawk " + goshawk::runtime::version());
  program.app().footer(kFooter);
  add_fly(program);
  add_plan(program);
  add_check(program);
  add_world(program);
  add_map(program);
  add_sense(program);
  add_campaign(program);
  add_launch(program);
  add_goto(program);
  add_hold(program);
  add_resume(program);
  add_land(program);
  add_takeoff(program);
  add_mission(program);
  add_why(program);
  add_place(program);
  add_view(program);
  add_run(program);
  add_secure(program);
  add_bench(program);
  add_conform(program);
  add_record(program);
  add_replay(program);
  add_bag(program);
  add_topic(program);
  add_node(program);
  add_interface(program);
  add_param(program);
  add_doctor(program);
  add_help(program);
}

/// For the completion of the shell: what may follow, a word a line (tools/completion.*).
int print_completions(const Program& program, const Words& words) {
  for (const auto& word : program.complete(words)) fmt::print("{}\n", word);
  return kDone;
}

}  // namespace

int main(int argc, char** argv) {
  Program program;
  describe(program);
  Words arguments(argv + 1, argv + argc);
  if (!arguments.empty() && arguments.front() == "complete") {
    return print_completions(program, {arguments.begin() + 1, arguments.end()});
  }
  return program.run(std::move(arguments));
}
