#pragma once

#include <cstdint>
#include <vector>

#include "goshawk/movers/mover.hpp"

namespace goshawk::movers {

/// The dynamic worlds of SANDO (arXiv 2604.07599, section IX-D), drawn by CPython's random numbers
/// as `_generate_obstacle_json` in scripts/run_sim.py of its repository draws them.
struct LeagueMovers {
  int count = 50;  // published: 50, 100, 200; 65 % are cubes on trefoils, the rest stand still
  std::uint32_t seed = 0;
  double divisor_min_s = 4.0, divisor_max_s = 6.0;  // of the trefoils' time; the fork has 10 to 12
  double speed_m_s = 0.0;  // mean speed of every trefoil instead; 0: as drawn
  bool still = true;       // with what stands still: pillars and bars
};

/// Cubes first (kind "cube"), then "pillar" and "bar", in the order in which they are drawn.
/// @return invalid_input for a count outside of 1 to 10,000, divisors below 0.01 s or out of order,
/// or a speed that is negative or not finite
Result<std::vector<Mover>> make_league_movers(const LeagueMovers& world);

}  // namespace goshawk::movers
