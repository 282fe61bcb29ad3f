#include "goshawk/movers/movers_file.hpp"

#include <fmt/format.h>

#include <array>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <fstream>
#include <iterator>
#include <numbers>

#include "goshawk/core/words.hpp"
#include "goshawk/movers/league_movers.hpp"
#include "track_file.hpp"
#include "yaml_keys.hpp"

namespace goshawk::movers {

constexpr auto words_of(Repeat) {
  using enum Repeat;
  return std::to_array<Named<Repeat>>(
      {{loop, "loop"}, {back_and_forth, "back_and_forth"}, {once, "once"}});
}

namespace {

constexpr double kDegrees = std::numbers::pi / 180.0;  // [rad]
constexpr std::size_t kMost = 10'000;                  // movers

/// The value of a result. @throws LineFault with its error's message and the line
template <typename T>
T checked(Result<T> result, int line) {
  if (!result) throw LineFault{line, result.error().message};
  return *std::move(result);
}

Motion read_still(const YAML::Node& node) {
  const YamlKeys keys(node, "still", {"position", "yaw_deg"});
  return Still{keys.vector("position"), kDegrees * keys.number("yaw_deg", 0.0)};
}

Motion read_walk(const YAML::Node& node) {
  const YamlKeys keys(
      node, "walk",
      {"points", "pauses_s", "speed_m_s", "acceleration_m_s2", "turn_rate_rad_s", "repeat"});
  WalkParameters p;
  p.points_map = keys.vectors("points");
  if (keys.has("pauses_s")) p.pauses_s = keys.numbers("pauses_s");
  p.speed_m_s = keys.number("speed_m_s");
  p.acceleration_m_s2 = keys.number("acceleration_m_s2", p.acceleration_m_s2);
  p.turn_rate_rad_s = keys.number("turn_rate_rad_s", p.turn_rate_rad_s);
  if (keys.has("repeat")) {
    const auto repeat = from_word<Repeat>(keys.word("repeat"));
    if (!repeat) {
      throw LineFault{keys.line(), "repeat is not one of loop, back_and_forth, once"};
    }
    p.repeat = *repeat;
  }
  return checked(Walk::create(p), keys.line());
}

Motion read_turn(const YAML::Node& node) {
  const YamlKeys keys(node, "turn", {"pivot", "axis", "arm", "amplitude_deg", "rate_rad_s"});
  Turn turn;
  turn.pivot_map = keys.vector("pivot");
  if (keys.has("axis")) turn.axis_map = keys.vector("axis");
  if (keys.has("arm")) turn.arm_map = keys.vector("arm");
  turn.amplitude_rad = kDegrees * keys.number("amplitude_deg", 0.0);
  turn.rate_rad_s = keys.number("rate_rad_s");
  if (turn.axis_map.norm() < 1e-6) throw LineFault{keys.line(), "axis has no direction"};
  turn.axis_map.normalize();
  if (!(turn.top_turn_rad_s() <= 30.0)) {
    throw LineFault{keys.line(), "it turns faster than 30 rad/s"};
  }
  return turn;
}

Motion read_slide(const YAML::Node& node) {
  const YamlKeys keys(node, "slide", {"center", "reach", "period_s"});
  const Slide slide{keys.vector("center"), keys.vector("reach"), keys.number("period_s")};
  if (!(slide.period_s >= 1e-2)) throw LineFault{keys.line(), "period_s is below 0.01"};
  return slide;
}

Motion read_trefoil(const YAML::Node& node) {
  const YamlKeys keys(node, "trefoil", {"center", "scale", "offset_rad", "divisor_s", "speed_m_s"});
  Trefoil trefoil{.center_map = keys.vector("center"),
                  .scale_m = keys.vector("scale"),
                  .offset_rad = keys.number("offset_rad", 0.0)};
  trefoil.divisor_s = keys.number("divisor_s", trefoil.divisor_s);
  if (keys.has("speed_m_s") && keys.has("divisor_s")) {
    throw LineFault{keys.line(), "a trefoil has divisor_s or speed_m_s, not both"};
  }
  if (!(trefoil.scale_m.minCoeff() > 0.0)) throw LineFault{keys.line(), "scale is not above 0"};
  if (keys.has("speed_m_s")) {
    const double speed = keys.number("speed_m_s");
    if (!(speed > 0.0)) throw LineFault{keys.line(), "speed_m_s is not above 0"};
    trefoil.divisor_s = trefoil.length_m() / (2.0 * std::numbers::pi * speed);
  }
  if (!(trefoil.divisor_s >= 1e-2)) throw LineFault{keys.line(), "divisor_s is below 0.01"};
  return trefoil;
}

Motion read_track_of(const YAML::Node& node, const std::filesystem::path& folder) {
  const YamlKeys keys(node, "track", {"file", "repeat"});
  auto places = checked(read_track(folder / keys.word("file")), keys.line());
  return checked(Track::create(std::move(places), keys.flag("repeat", false)), keys.line());
}

void add_league(const YAML::Node& node, std::vector<Mover>& movers) {
  const YamlKeys keys(node, "league", {"count", "seed", "divisor_s", "speed_m_s", "still"});
  LeagueMovers world;
  world.count = keys.integer("count", 1, int(kMost));
  if (keys.has("seed")) world.seed = std::uint32_t(keys.integer("seed", 0, 2147483647));
  if (keys.has("divisor_s")) {
    const auto range = keys.numbers("divisor_s");
    if (range.size() != 2) throw LineFault{keys.line(), "divisor_s is not two numbers"};
    world.divisor_min_s = range[0], world.divisor_max_s = range[1];
  }
  world.speed_m_s = keys.number("speed_m_s", 0.0);
  world.still = keys.flag("still", true);
  for (Mover& mover : checked(make_league_movers(world), keys.line())) {
    movers.push_back(std::move(mover));
  }
}

Motion read_motion(const YamlKeys& keys, const std::filesystem::path& folder) {
  std::vector<std::string> given;
  for (const char* key : {"still", "walk", "turn", "slide", "trefoil", "track"}) {
    if (keys.has(key)) given.emplace_back(key);
  }
  if (given.size() != 1) {
    throw LineFault{keys.line(),
                    "a mover needs one of still, walk, turn, slide, trefoil, track, league"};
  }
  const std::string& kind = given.front();
  const YAML::Node node = keys.at(kind);
  if (kind == "still") return read_still(node);
  if (kind == "walk") return read_walk(node);
  if (kind == "turn") return read_turn(node);
  if (kind == "slide") return read_slide(node);
  if (kind == "trefoil") return read_trefoil(node);
  return read_track_of(node, folder);
}

void add_mover(const YAML::Node& node, const std::filesystem::path& folder,
               std::vector<Mover>& movers) {
  const YamlKeys keys(
      node, "a mover",
      {"kind", "size", "start_s", "still", "walk", "turn", "slide", "trefoil", "track", "league"});
  if (keys.has("league")) {
    if (node.size() != 1) throw LineFault{keys.line(), "league has no key beside it"};
    return add_league(keys.at("league"), movers);
  }
  Mover mover;
  if (keys.has("kind")) mover.kind = keys.word("kind");
  mover.half_m = 0.5 * keys.vector("size");
  if (!(mover.half_m.minCoeff() >= 5e-4 && mover.half_m.maxCoeff() <= 50.0)) {
    throw LineFault{keys.line(), "size is outside of 0.001 to 100 m"};
  }
  mover.start_s = keys.number("start_s", 0.0);
  if (!(std::abs(mover.start_s) <= 1e10)) throw LineFault{keys.line(), "start_s is beyond 1e10 s"};
  mover.motion = read_motion(keys, folder);
  if (!(mover.at(0.0).position_map.cwiseAbs().maxCoeff() <= 1e6)) {
    throw LineFault{keys.line(), "it lies beyond 1e6 m"};
  }
  // What is faster is a mistake of units, and no contact could be judged exactly.
  if (!(mover.top_point_speed_m_s() <= 1e3)) {
    throw LineFault{keys.line(), "it moves faster than 1000 m/s"};
  }
  movers.push_back(std::move(mover));
}

std::vector<Mover> movers_in(const YAML::Node& root, const std::filesystem::path& folder) {
  const YamlKeys keys(root, "a file of movers", {"movers"});
  const YAML::Node list = keys.at("movers");
  if (!list.IsSequence()) throw LineFault{keys.line(), "movers is not a list"};
  std::vector<Mover> movers;
  for (const auto& node : list) {
    add_mover(node, folder, movers);
    if (movers.size() > kMost) {
      throw LineFault{node.Mark().line + 1, fmt::format("there are more than {} movers", kMost)};
    }
  }
  for (std::size_t i = 0; i < movers.size(); ++i) movers[i].id = i + 1;
  return movers;
}

}  // namespace

Result<std::vector<Mover>> parse_movers(const std::filesystem::path& name,
                                        const std::string& text) {
  const auto wrong = [&](int line, const std::string& what) {
    return fail(ErrorCode::invalid_input,
                fmt::format("{}, line {}: {}", name.string(), line, what));
  };
  try {
    return movers_in(YAML::Load(text), name.parent_path());
  } catch (const LineFault& fault) {
    return wrong(fault.line, fault.message);
  } catch (const YAML::Exception& fault) {
    return wrong(fault.mark.line + 1, "it is not valid YAML: " + fault.msg);
  }
}

Result<std::vector<Mover>> read_movers(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  stream.peek();  // a folder can be opened, but not read
  if (!stream.is_open() || stream.bad()) {
    return fail(ErrorCode::io_failed,
                fmt::format("{} cannot be read: {}", file.string(), std::strerror(errno)));
  }
  const std::string text(std::istreambuf_iterator<char>(stream), {});
  return parse_movers(file, text);
}

}  // namespace goshawk::movers
