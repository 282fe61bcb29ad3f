#include "process.hpp"
#include "values.hpp"
#include "verbs/verbs.hpp"

namespace goshawk::cli {
namespace {

struct SecureOptions {
  std::string folder;
  std::string name_space = "/";
  int days = 3650;
  Words like;
};

int run_init(const SecureOptions& o, const Console& console) {
  return become_helper(
      "secure.py",
      {{"folder", o.folder}, {"namespace", o.name_space}, {"days", o.days}, {"like", o.like}},
      console);
}

}  // namespace

void add_secure(Program& program) {
  const Verb secure = program.verb("secure", "DDS Security: who may read and write what");
  const Verb verb = secure.word(
      "init", "make an authority, and a certificate with signed permissions for each stage");
  auto o = std::make_shared<SecureOptions>();
  verb->add_option("folder", o->folder, "a new or empty folder")->required();
  verb->add_option("--namespace", o->name_space, "of the vehicle, as in its launch file")
      ->capture_default_str();
  verb->add_option("--days", o->days, "for which certificates and permissions hold")
      ->check(CLI::Range(1, 36500))
      ->capture_default_str();
  verb->add_option("--like", o->like,
                   "NAME=ROLE: also one for a program of your own, which a launch file names so, "
                   "with the rights of that role; may repeat");
  verb->footer(
      "Needs openssl. Roles: map_server, path_search, corridor_builder, trajectory_optimizer,\n"
      "navigator, mission, tracker, vehicle, flight_check, sensors, visualizer, viewer, recorder,\n"
      "operator.\n\n"
      "Examples:\n"
      "  goshawk secure init keys\n"
      "  goshawk secure init keys --namespace /uav1 --like my_search=path_search\n"
      "  goshawk launch flight --secure keys");
  verb.runs([o](const Console& console) { return run_init(*o, console); });
}

}  // namespace goshawk::cli
