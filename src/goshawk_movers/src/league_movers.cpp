#include "goshawk/movers/league_movers.hpp"

#include <cmath>
#include <numbers>

#include "goshawk/worlds/python_random.hpp"

namespace goshawk::movers {
namespace {

constexpr double kMovingShare = 0.65, kPillarShare = 0.35;
constexpr double kCube_m = 0.8;
constexpr double kPillarHeight_m = 2.0;
constexpr double kLeastDivisor_s = 1e-2;  // below, a trefoil is faster than 1000 m/s

Status check(const LeagueMovers& w) {
  const bool divisors = w.divisor_min_s >= kLeastDivisor_s && w.divisor_min_s <= w.divisor_max_s &&
                        std::isfinite(w.divisor_max_s);
  if (w.count < 1 || w.count > 10'000) {
    return fail(ErrorCode::invalid_input, "count is outside of 1 to 10,000");
  }
  if (!divisors) {
    return fail(ErrorCode::invalid_input,
                "divisor_s needs two numbers of 0.01 or more, the smaller first");
  }
  if (!(w.speed_m_s >= 0.0 && w.speed_m_s <= 100.0)) {
    return fail(ErrorCode::invalid_input, "speed is outside of 0 to 100 m/s");
  }
  return success();
}

Vec3 draw_place(worlds::PythonRandom& random) {
  const double x = random.uniform(5.0, 100.0);
  const double y = random.uniform(-6.0, 6.0);
  return {x, y, random.uniform(0.5, 4.5)};
}

Trefoil draw_trefoil(worlds::PythonRandom& random, const LeagueMovers& w) {
  Trefoil trefoil{.center_map = draw_place(random)};
  for (double& scale : trefoil.scale_m) scale = random.uniform(2.0, 4.0);
  trefoil.offset_rad = random.uniform(0.0, 3.0);
  trefoil.divisor_s = random.uniform(w.divisor_min_s, w.divisor_max_s);
  if (w.speed_m_s > 0.0) {
    trefoil.divisor_s = trefoil.length_m() / (2.0 * std::numbers::pi * w.speed_m_s);
  }
  return trefoil;
}

}  // namespace

Result<std::vector<Mover>> make_league_movers(const LeagueMovers& w) {
  if (auto status = check(w); !status) return status.error();
  worlds::PythonRandom random(w.seed);
  std::vector<Mover> movers;
  const int moving = int(kMovingShare * w.count), still = w.count - moving;
  for (int i = 0; i < moving; ++i) {
    movers.push_back({.id = movers.size() + 1,
                      .kind = "cube",
                      .half_m = Vec3::Constant(0.5 * kCube_m),
                      .motion = draw_trefoil(random, w)});
  }
  for (int i = 0; i < still && w.still; ++i) {
    const bool pillar = i < kPillarShare * still;
    Vec3 place = draw_place(random);
    if (pillar) place.z() = kPillarHeight_m;
    movers.push_back({.id = movers.size() + 1,
                      .kind = pillar ? "pillar" : "bar",
                      .half_m = pillar ? Vec3(0.2, 0.2, 2.0) : Vec3(0.2, 2.0, 0.2),
                      .motion = Still{.position_map = place}});
  }
  return movers;
}

}  // namespace goshawk::movers
