#include <fmt/format.h>

#include "goshawk/worlds/world.hpp"
#include "process.hpp"
#include "values.hpp"
#include "verbs/verbs.hpp"

namespace goshawk::cli {
namespace {

struct CampaignOptions {
  int missions = 20;
  int goals = 5;
  std::int64_t seed = 1;
  std::vector<std::string> kinds = {"boxes", "forest", "office"};
  std::vector<double> densities = {0.1, 0.2, 0.3};
  std::vector<double> wind_m_s = {0.0, 1.5, 3.0};
  std::vector<double> noise_m = {0.0};
  Vec3 size_m = Vec3(10.0, 10.0, 4.0);
  std::optional<int> jobs;
  std::string engine = "local";
  std::vector<std::string> sbatch;
  double timeout_s = 60.0;
  std::vector<std::string> faults;
  std::string launch;
  std::vector<std::string> parameters;
  std::string output = "campaign";
};

constexpr char kLockStep[] = "flight_lock_step";

int run_campaign(CampaignOptions o, const Console& console) {
  if (o.launch.empty()) o.launch = o.faults.empty() ? kLockStep : "flight";
  if (!o.faults.empty() && o.launch == kLockStep) {
    return console.wrong_call(
        fail(ErrorCode::invalid_parameter,
             "--faults needs processes of their own in real time: in lock step each waits for all "
             "others; use --launch flight"));
  }
  Words parameters = o.parameters;
  if (parameters.empty() && o.launch == kLockStep) parameters = {"simulator:speed:=0"};
  return become_helper("campaign.py",
                       {{"missions", o.missions},
                        {"goals", o.goals},
                        {"seed", o.seed},
                        {"kinds", o.kinds},
                        {"densities", o.densities},
                        {"wind", o.wind_m_s},
                        {"noise", o.noise_m},
                        {"size", fmt::format("{},{},{}", o.size_m.x(), o.size_m.y(), o.size_m.z())},
                        {"jobs", o.jobs ? Json(*o.jobs) : Json()},
                        {"engine", o.engine},
                        {"sbatch", o.sbatch},
                        {"timeout_s", o.timeout_s},
                        {"faults", o.faults},
                        {"launch", o.launch},
                        {"parameters", parameters},
                        {"output", o.output}},
                       console);
}

/// Numbers with commas between them.
void add_numbers(const Verb& verb, const std::string& name, std::vector<double>& values,
                 double most, const std::string& what) {
  verb->add_option(name, values, what)
      ->delimiter(',')
      ->check(CLI::Range(0.0, most))
      ->capture_default_str();
}

}  // namespace

void add_campaign(Program& program) {
  const Verb verb =
      program.verb("campaign", "fly many random missions, several at once, judged, with a summary");
  auto o = std::make_shared<CampaignOptions>();
  const CLI::Range at_least_one(1, 1'000'000'000);
  const auto add_count = [&](const std::string& name, int& value, const std::string& what) {
    verb->add_option(name, value, what)->capture_default_str()->check(at_least_one);
  };
  add_count("--missions", o->missions, "worlds");
  add_count("--goals", o->goals, "flights in each world");
  verb->add_option("--seed", o->seed, "of everything random")->capture_default_str();
  verb->add_option("--kinds", o->kinds, "boxes,forest,office,noise")
      ->delimiter(',')
      ->check(CLI::IsMember(worlds::world_kinds()))
      ->capture_default_str();
  add_numbers(verb, "--densities", o->densities, 0.95, "0.1,0.2,...");
  add_numbers(verb, "--wind", o->wind_m_s, 15.0, "[m/s] 0,1.5,...");
  add_numbers(verb, "--noise", o->noise_m, 1.0, "[m] of the odometry: 0,0.005,...");
  add_point(verb, "--size", o->size_m, "[m] of the worlds");
  verb->add_option("--jobs", o->jobs, "missions at once (default 2; with Slurm as many as it will)")
      ->check(at_least_one);
  verb->add_option("--engine", o->engine, "local, or slurm: an array job of a cluster")
      ->capture_default_str()
      ->check(CLI::IsMember({"local", "slurm"}));
  verb->add_option("--sbatch", o->sbatch,
                   "option of Slurm's sbatch, as in --sbatch=--partition=long; may repeat");
  verb->add_option("--timeout", o->timeout_s, "[s] for each goal")
      ->capture_default_str()
      ->check(CLI::Range(1.0, 3600.0));
  verb->add_option("--faults", o->faults, "kill,stall,clock,loss,blind,hostile: at random moments")
      ->delimiter(',')
      ->check(CLI::IsMember({"kill", "stall", "clock", "loss", "blind", "hostile"}));
  auto* launch = verb->add_option("--launch", o->launch,
                                  "launch file (default: flight_lock_step, where missions repeat "
                                  "bit for bit; with --faults flight). live: without a map, by "
                                  "a lidar");
  verb.completes(launch, launch_files);
  verb->add_option("-p", o->parameters,
                   "NODE:NAME:=VALUE of a stage; may repeat (default in lock step: "
                   "simulator:speed:=0, as fast as it goes)");
  verb->add_option("--output", o->output, "folder")->capture_default_str();
  verb->footer(
      "A campaign that is called again with the same folder continues.\n\n"
      "Examples:\n"
      "  goshawk campaign --missions 50 --goals 3 --output campaign\n"
      "  goshawk campaign --faults kill,stall,clock,loss,blind,hostile --missions 10\n"
      "  goshawk campaign --kinds forest,office --densities 0.1,0.2,0.3 --wind 0,2");
  verb.runs([o](const Console& console) { return run_campaign(*o, console); });
}

}  // namespace goshawk::cli
