#include <cstdio>
#include <filesystem>

#include "goshawk/flight_check/track_file.hpp"
#include "verbs.hpp"

namespace goshawk::cli {
namespace {

using flight_check::Body;
using flight_check::FlightCheck;
using flight_check::Verdict;

struct CheckOptions {
  std::string flight;
  std::string map;
  Body body;
  std::string box;
  bool unknown = false;
  double yaw_rad = 0.0;
  bool json = false;

  void add_to(CLI::App& app) {
    app.add_option("flight", flight, "flight folder (with flown.csv and world.bt), or a table")
        ->required();
    app.add_option("--map", map, ".bt or .ot (default: world.bt of the folder)");
    app.add_option("--radius", body.radius_m, "[m] of the body's cylinder")->capture_default_str();
    app.add_option("--height", body.height_m, "[m] of the body")->capture_default_str();
    app.add_option("--box", box, "length,width,height [m]: the body is a box");
    app.add_option("--yaw", yaw_rad, "[rad] of the planned legs")->capture_default_str();
    app.add_flag("--unknown", unknown, "unknown space and all outside of the map are obstacles");
    app.add_flag("--json", json, "print one JSON object (docs/cli.md)");
  }
};

Json to_json(const Verdict& v) {
  return {{"touched", v.touched},
          {"smallest_m", cli::to_json(v.clearance_m)},
          {"at_s", cli::to_json(v.clearance_t_s)},
          {"place", cli::to_json(v.clearance_place_map)},
          {"samples", v.samples},
          {"sentence", v.sentence}};
}

struct Judged {
  Verdict flown;
  std::vector<Verdict> planned;  // leg by leg
  /// The flight's own contact, else the first planned one; nothing where all is well.
  const Verdict* contact() const {
    if (flown.touched) return &flown;
    const auto leg = std::ranges::find_if(planned, &Verdict::touched);
    return leg == planned.end() ? nullptr : &*leg;
  }
  bool touched() const { return contact() != nullptr; }
};

Result<Body> body_of(const CheckOptions& o) {
  Body body = o.body;
  if (!o.box.empty()) {
    const auto edges = parse_point(o.box);
    if (!edges) {
      return fail(ErrorCode::invalid_parameter, "--box: length,width,height in metres are meant");
    }
    body.is_box = true;
    body.length_m = edges->x();
    body.width_m = edges->y();
    body.height_m = edges->z();
  }
  if (auto status = body.check(); !status) return status.error();
  return body;
}

Result<Judged> judge(const CheckOptions& o, const Body& body) {
  const std::filesystem::path flight(o.flight);
  std::error_code ignored;
  const bool folder = std::filesystem::is_directory(flight, ignored);
  if (!folder && o.map.empty()) {
    return fail(ErrorCode::invalid_parameter,
                "'" + o.flight + "' is no flight folder: name one, or a table and its --map");
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
  Judged judged{*std::move(flown), {}};
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

void print(const Judged& judged, const CheckOptions& o) {
  const ErrorCode code = judged.touched() ? ErrorCode::collision : ErrorCode::ok;
  if (o.json) {
    Json planned = Json::array();
    for (const auto& verdict : judged.planned) planned.push_back(to_json(verdict));
    const Json object{{"ok", !judged.touched()},
                      {"code", to_string(code)},
                      {"message", judged.touched() ? judged.contact()->sentence : ""},
                      {"verdict", judged.touched() ? "touched" : "safe"},
                      {"flown", to_json(judged.flown)},
                      {"planned", planned}};
    std::printf("%s\n", object.dump(2, ' ', false, Json::error_handler_t::replace).c_str());
    return;
  }
  std::printf("flown    %s\n", judged.flown.sentence.c_str());
  for (std::size_t i = 0; i < judged.planned.size(); ++i) {
    std::printf("leg %-4zu %s\n", i + 1, judged.planned[i].sentence.c_str());
  }
  std::printf("verdict: %s\n", judged.touched() ? "touched" : "safe");
}

}  // namespace

int check_command(const Arguments& arguments) {
  CLI::App app("Judge a flight: the vehicle's body, in its true attitude, against the raw map.",
               "goshawk check");
  app.footer(
      "Examples:\n"
      "  goshawk check flights/DATE\n"
      "  goshawk check flown.csv --map world.bt --box 0.3,0.3,0.12");
  CheckOptions options;
  options.add_to(app);
  if (const auto status = parse(app, arguments)) return *status;
  const auto body = body_of(options);
  if (!body) return report_failure(body.error(), options.json, kWrongCall);
  const auto judged = judge(options, *body);
  if (!judged) {
    const bool wrong = judged.code() == ErrorCode::invalid_parameter;
    return report_failure(judged.error(), options.json, wrong ? kWrongCall : kNotDone);
  }
  print(*judged, options);
  return judged->touched() ? kNotDone : kDone;
}

}  // namespace goshawk::cli
