// One flight of the league; tools/league asks for many. Prints one JSON object.
#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cstdio>
#include <fstream>
#include <nlohmann/json.hpp>
#include <optional>

#include "goshawk/league/flight.hpp"
#include "goshawk/league/settings.hpp"

namespace goshawk::league {
namespace {

constexpr char kUsage[] =
    "usage: goshawk_league_flight WORLD [--seed N] [--tracking true|ideal] [--known]\n"
    "           [--noise METRES] [--latency SECONDS] [--track FILE] [--vehicle FILE]\n"
    "           [-p NODE:PARAMETER=VALUE ...]\n"
    "       goshawk_league_flight --list\n";

struct Arguments {
  std::string world;
  Options options;
  std::string track_file;
  std::filesystem::path vehicle_file;
  std::vector<std::string> settings;  // as apply_setting() takes them
  bool list = false;
};

Error bad(const std::string& why) {
  return fail(ErrorCode::invalid_parameter, why);
}

template <typename Number>
Result<Number> number_of(const std::string& option, const std::string& text) {
  Number value{};
  const auto [end, code] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (code == std::errc() && end == text.data() + text.size()) return value;
  return bad(fmt::format("{} needs a number, not '{}'", option, text));
}

Status set(const std::string& option, const std::string& value, Arguments& a) {
  if (option == "-p") {
    a.settings.push_back(value);
  } else if (option == "--vehicle") {
    a.vehicle_file = value;
  } else if (option == "--track") {
    a.track_file = value;
  } else if (option == "--tracking" && (value == "true" || value == "ideal")) {
    a.options.tracking =
        value == "true" ? closed_loop::Tracking::physical : closed_loop::Tracking::ideal;
  } else if (option == "--seed") {
    const auto seed = number_of<std::uint64_t>(option, value);
    if (!seed) return seed.error();
    a.options.seed = *seed;
  } else if (option == "--noise" || option == "--latency") {
    const auto number = number_of<double>(option, value);
    if (!number) return number.error();
    if (!(*number >= 0.0 && *number <= 10.0)) return bad(option + " is from 0 to 10");
    if (option == "--noise") a.options.range_noise_m = *number;
    if (option == "--latency") a.options.latency_s = *number;
  } else {
    return bad(fmt::format("'{} {}' is not understood", option, value));
  }
  return success();
}

Result<Arguments> parse(int argc, char** argv) {
  Arguments a;
  for (int i = 1; i < argc; ++i) {
    const std::string word = argv[i];
    if (word == "--list") {
      a.list = true;
    } else if (word == "--known") {
      a.options.known = true;
    } else if (!word.starts_with("-") && a.world.empty()) {
      a.world = word;
    } else if (i + 1 < argc) {
      if (auto status = set(word, argv[++i], a); !status) return status.error();
    } else {
      return bad(fmt::format("'{}' is not understood", word));
    }
  }
  if (a.vehicle_file.empty()) {
    const auto here = std::filesystem::weakly_canonical(argv[0]).parent_path();
    a.vehicle_file = here / "../../share/goshawk/config/racer.yaml";
  }
  if (!a.list && a.world.empty()) return bad("no world is named");
  return a;
}

// [ms] nearest rank
nlohmann::json share_ms(std::vector<double> all_s, double share) {
  if (all_s.empty()) return nullptr;
  std::ranges::sort(all_s);
  return 1e3 * all_s[std::min(all_s.size() - 1, std::size_t(share * double(all_s.size())))];
}

nlohmann::json replan_ms(const Outcome& o, double share, double (*of)(const closed_loop::Replan&)) {
  std::vector<double> all_s;
  for (const auto& replan : o.replans) all_s.push_back(of(replan));
  return share_ms(std::move(all_s), share);
}

nlohmann::json replans_json(const Outcome& o) {
  using closed_loop::Replan;
  nlohmann::json stages;
  const auto add = [&](const char* name, double (*of)(const Replan&)) {
    stages[name] = {{"p50_ms", replan_ms(o, 0.5, of)}, {"p99_ms", replan_ms(o, 0.99, of)}};
  };
  add("search", [](const Replan& r) { return r.stages.search_s; });
  add("corridor", [](const Replan& r) { return r.stages.corridor_s; });
  add("optimizer", [](const Replan& r) { return r.stages.optimizer_s; });
  add("check", [](const Replan& r) { return r.check_s; });
  return stages;
}

double all_s(const closed_loop::Replan& replan) {
  return replan.all_s();
}

nlohmann::json to_json(const Scene& scene, const Arguments& arguments, const Outcome& o) {
  const Options& options = arguments.options;
  const Limits& l = scene.limits;
  return {{"world", scene.name},
          {"seed", options.seed},
          {"tracking", options.tracking == closed_loop::Tracking::ideal ? "ideal" : "true"},
          {"known", options.known},
          {"noise_m", options.range_noise_m},
          {"settings", arguments.settings},
          {"arrived", o.arrived},
          {"reason", o.reason},
          {"touched", o.verdict.touched},
          {"clearance_m", o.verdict.clearance_m},
          {"verdict", o.verdict.sentence},
          {"time_s", o.time_s},
          {"length_m", o.length_m},
          {"mean_speed_m_s", o.time_s > 0.0 ? o.length_m / o.time_s : 0.0},
          {"top_speed_m_s", o.top_speed_m_s},
          {"violations", o.violations},
          {"worst_use", o.worst_use},
          {"jerk_m_s2", o.jerk_m_s2},
          {"max_error_m", o.max_error_m},
          {"plans", o.plans},
          {"failed_plans", o.failed_plans},
          {"commits", o.commits},
          {"stops", o.stops},
          {"events", o.events},
          {"replan_p50_ms", replan_ms(o, 0.5, all_s)},
          {"replan_p99_ms", replan_ms(o, 0.99, all_s)},
          {"replan_stages", replans_json(o)},
          {"scan_p50_ms", share_ms(o.scan_s, 0.5)},
          {"scan_p99_ms", share_ms(o.scan_s, 0.99)},
          {"limits", {{"v_m_s", l.v_max_m_s}, {"a_m_s2", l.a_max_m_s2}, {"j_m_s3", l.j_max_m_s3}}}};
}

// A tenth of the samples, and the solids: for a picture.
bool write_track(const std::string& file, const Scene& scene, const Outcome& outcome) {
  nlohmann::json track = nlohmann::json::array(), solids = nlohmann::json::array();
  for (std::size_t i = 0; i < outcome.track.size(); i += 10) {
    const Moment& m = outcome.track[i];
    const Vec3& p = m.vehicle.position_map;
    track.push_back({m.t_s, p.x(), p.y(), p.z(), m.vehicle.velocity_map.norm()});
  }
  for (const Solid& s : scene.solids) {
    const Vec3 &c = s.center_map, &d = s.size_m;
    solids.push_back(
        {{"box", s.is_box}, {"center", {c.x(), c.y(), c.z()}}, {"size", {d.x(), d.y(), d.z()}}});
  }
  const Vec3 &lo = scene.box.lower_map, &hi = scene.box.upper_map;
  std::ofstream out(file);
  out << nlohmann::json{{"track", track},
                        {"solids", solids},
                        {"start", {scene.start.x(), scene.start.y(), scene.start.z()}},
                        {"goal", {scene.goal.x(), scene.goal.y(), scene.goal.z()}},
                        {"box", {lo.x(), lo.y(), lo.z(), hi.x(), hi.y(), hi.z()}}};
  return bool(out.flush());
}

int complain(const std::string& why) {
  fmt::print(stderr, "goshawk_league_flight: {}\n", why);
  return 2;
}

/// The vehicle's file, then what is set beside it.
Status set_vehicle(Arguments& arguments) {
  closed_loop::Setup& vehicle = arguments.options.vehicle;
  if (auto status = apply_file(arguments.vehicle_file, vehicle); !status) return status;
  for (const std::string& setting : arguments.settings) {
    if (auto status = apply_setting(setting, vehicle); !status) return status;
  }
  return success();
}

int run(Arguments arguments) {
  if (arguments.list) {
    for (const auto& name : scene_names()) fmt::print("{}\n", name);
    return 0;
  }
  if (auto status = set_vehicle(arguments); !status) return complain(status.error().message);
  const auto scene = make_scene(arguments.world, arguments.options.seed);
  if (!scene) return complain(scene.error().message);
  const auto outcome = fly(*scene, arguments.options);
  if (!outcome) return complain(outcome.error().message);
  fmt::print("{}\n", to_json(*scene, arguments, *outcome).dump());
  if (!arguments.track_file.empty() && !write_track(arguments.track_file, *scene, *outcome)) {
    return complain("cannot write " + arguments.track_file);
  }
  return 0;
}

}  // namespace
}  // namespace goshawk::league

int main(int argc, char** argv) {
  const auto arguments = goshawk::league::parse(argc, argv);
  if (arguments) return goshawk::league::run(*arguments);
  goshawk::league::complain(arguments.error().message);
  std::fputs(goshawk::league::kUsage, stderr);
  return 2;
}
