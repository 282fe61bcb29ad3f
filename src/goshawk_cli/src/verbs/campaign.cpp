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
  int jobs = 2;
  std::string launch = "flight_lock_step";
  std::vector<std::string> parameters;
  std::string output = "campaign";
};

int run_campaign(const CampaignOptions& o, const Console& console) {
  Words parameters = o.parameters;
  if (parameters.empty() && o.launch == "flight_lock_step") parameters = {"simulator:speed:=0"};
  return become_helper(
      "campaign.py",
      {{"missions", o.missions},
       {"goals", o.goals},
       {"seed", o.seed},
       {"kinds", o.kinds},
       {"densities", o.densities},
       {"wind", o.wind_m_s},
       {"noise", o.noise_m},
       {"size", fmt::format("{},{},{}", o.size_m.x(), o.size_m.y(), o.size_m.z())},
       {"jobs", o.jobs},
       {"launch", o.launch},
       {"parameters", parameters},
       {"output", o.output}},
      console);
}

/// Numbers with commas between them.
void add_numbers(const Verb& verb, const std::string& name, std::vector<double>& values, double most,
                 const std::string& what) {
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
  add_count("--jobs", o->jobs, "missions at once");
  auto* launch =
      verb->add_option("--launch", o->launch,
                       "launch file: flight_lock_step, where missions repeat bit for bit, or flight")
          ->capture_default_str();
  verb.completes(launch, launch_files);
  verb->add_option("-p", o->parameters,
                   "NODE:NAME:=VALUE of a stage; may repeat (default in lock step: "
                   "simulator:speed:=0, as fast as it goes)");
  verb->add_option("--output", o->output, "folder")->capture_default_str();
  verb->footer(
      "A campaign that is called again with the same folder continues.\n\n"
      "Examples:\n"
      "  goshawk campaign --missions 50 --goals 3 --output campaign\n"
      "  goshawk campaign --kinds forest,office --densities 0.1,0.2,0.3 --wind 0,2");
  verb.runs([o](const Console& console) { return run_campaign(*o, console); });
}

}  // namespace goshawk::cli
