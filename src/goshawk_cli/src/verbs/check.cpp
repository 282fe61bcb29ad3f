#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "goshawk/flight_check/mover_check.hpp"
#include "goshawk/flight_check/track_file.hpp"
#include "goshawk/movers/movers_file.hpp"
#include "json.hpp"
#include "values.hpp"
#include "verbs/verbs.hpp"

namespace goshawk::cli {
namespace {

using flight_check::Body;
using flight_check::FlightCheck;
using flight_check::MoverCheck;
using flight_check::MoverVerdict;
using flight_check::Verdict;

struct CheckOptions {
  std::string flight;
  std::string map;
  Body body;
  std::optional<Vec3> box_m;
  bool unknown = false;
  double yaw_rad = 0.0;
  std::string movers;
  double movers_start_s = 0.0;
};

Json verdict_json(const Verdict& v) {
  return {{"touched", v.touched},
          {"smallest_m", to_json(v.clearance_m)},
          {"at_s", to_json(v.clearance_t_s)},
          {"place", to_json(v.clearance_place_map)},
          {"samples", v.samples},
          {"sentence", v.sentence}};
}

Json movers_json(const std::optional<MoverVerdict>& v) {
  if (!v) return nullptr;
  return {{"touched", v->touched},
          {"smallest_m", to_json(v->clearance_m)},
          {"at_s", to_json(v->clearance_t_s)},
          {"place", to_json(v->clearance_place_map)},
          {"sentence", v->sentence()}};
}

struct Judged {
  Verdict flown;
  std::vector<Verdict> planned;        // leg by leg
  std::optional<MoverVerdict> movers;  // of what was flown, if it is known what moves

  /// About the flight's own contact with the map or with a mover, else about the first planned one;
  /// empty if nothing was touched.
  std::string contact() const {
    if (flown.touched) return flown.sentence;
    if (movers && !movers->touched.empty()) return movers->sentence();
    const auto leg = std::ranges::find_if(planned, &Verdict::touched);
    return leg == planned.end() ? "" : leg->sentence;
  }
};

Result<Body> body_of(const CheckOptions& o) {
  Body body = o.body;
  if (o.box_m) {
    body.is_box = true;
    body.length_m = o.box_m->x();
    body.width_m = o.box_m->y();
    body.height_m = o.box_m->z();
  }
  if (auto status = body.check(); !status) return status.error();
  return body;
}

Result<std::optional<MoverVerdict>> judge_movers(const CheckOptions& o, const Body& body,
                                                 std::span<const flight_check::Sample> track) {
  if (o.movers.empty()) return std::optional<MoverVerdict>();
  auto movers = movers::read_movers(o.movers);
  if (!movers) return movers.error();
  const auto check = MoverCheck::create(*std::move(movers), o.movers_start_s, body);
  if (!check) return check.error();
  auto verdict = check->judge(track);
  if (!verdict) return verdict.error();
  return std::optional(*std::move(verdict));
}

Result<Judged> judge(const CheckOptions& o, const Body& body) {
  const std::filesystem::path flight(o.flight);
  std::error_code ignored;
  const bool folder = std::filesystem::is_directory(flight, ignored);
  if (!folder && o.map.empty()) {
    return fail(
        ErrorCode::invalid_parameter,
        fmt::format("'{}' is not a flight folder: name one, or a table and its --map", o.flight));
  }
  const auto check =
      FlightCheck::open(o.map.empty() ? flight / "world.bt" : std::filesystem::path(o.map), body,
                        {.count_unknown_as_obstacle = o.unknown});
  if (!check) return check.error();
  const auto track = flight_check::read_flown_csv(folder ? flight / "flown.csv" : flight);
  if (!track) return track.error();
  if (auto gaps = flight_check::check_gaps(*track); !gaps) return gaps.error();
  auto flown = check->judge(*track);
  if (!flown) return flown.error();
  auto movers = judge_movers(o, body, *track);
  if (!movers) return movers.error();
  Judged judged{*std::move(flown), {}, *std::move(movers)};
  if (!folder || !std::filesystem::exists(flight / "trajectory.csv", ignored)) return judged;
  const auto legs = flight_check::read_planned_csv(flight / "trajectory.csv", o.yaw_rad);
  if (!legs) return legs.error();
  for (const auto& leg : *legs) {
    auto verdict = check->judge(leg);
    if (!verdict) return verdict.error();
    judged.planned.push_back(*std::move(verdict));
  }
  return judged;
}

Json judged_json(const Judged& judged) {
  const std::string contact = judged.contact();
  Json planned = Json::array();
  for (const auto& verdict : judged.planned) planned.push_back(verdict_json(verdict));
  return {{"ok", contact.empty()},
          {"code", to_string(contact.empty() ? ErrorCode::ok : ErrorCode::collision)},
          {"message", contact},
          {"verdict", contact.empty() ? "safe" : "touched"},
          {"flown", verdict_json(judged.flown)},
          {"movers", movers_json(judged.movers)},
          {"planned", planned}};
}

void print(const Judged& judged) {
  fmt::print("flown    {}\n", judged.flown.sentence);
  if (judged.movers) fmt::print("movers   {}\n", judged.movers->sentence());
  for (std::size_t i = 0; i < judged.planned.size(); ++i) {
    fmt::print("leg {:<4} {}\n", i + 1, judged.planned[i].sentence);
  }
  fmt::print("verdict: {}\n", judged.contact().empty() ? "safe" : "touched");
}

int run_check(const CheckOptions& o, const Console& console) {
  const auto body = body_of(o);
  if (!body) return console.wrong_call(body.error());
  const auto judged = judge(o, *body);
  if (!judged) return console.failed(judged.error());
  console.json() ? console.print(judged_json(*judged)) : print(*judged);
  return judged->contact().empty() ? kDone : kNotDone;
}

}  // namespace

void add_check(Program& program) {
  const Verb verb = program.verb(
      "check", "judge a flight anew: the body in its true attitude against the raw map");
  auto o = std::make_shared<CheckOptions>();
  verb->add_option("flight", o->flight,
                   "flight folder (with flown.csv and world.bt), or a table like flown.csv")
      ->required();
  verb->add_option("--map", o->map, ".bt or .ot (default: world.bt of the folder)");
  verb->add_option("--radius", o->body.radius_m, "[m] of the body's cylinder")
      ->capture_default_str();
  verb->add_option("--height", o->body.height_m, "[m] of the body")->capture_default_str();
  add_point(verb, "--box", o->box_m, "[m] length,width,height: the body is a box");
  verb->add_option("--yaw", o->yaw_rad, "[rad] of the planned legs")->capture_default_str();
  verb->add_flag("--unknown", o->unknown,
                 "unknown space and everything outside of the map are obstacles");
  verb->add_option("--movers", o->movers,
                   "what moved (docs/movers.md): judged against what was flown");
  verb->add_option("--movers-start", o->movers_start_s,
                   "[s] of the table, when the movers' time is 0; may be negative")
      ->capture_default_str();
  verb->footer(
      "Examples:\n"
      "  goshawk check flights/DATE\n"
      "  goshawk check flown.csv --map world.bt --box 0.3,0.3,0.12");
  verb.runs([o](const Console& console) { return run_check(*o, console); });
}

}  // namespace goshawk::cli
