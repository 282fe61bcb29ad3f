// Goals that come in flight, at random moments and to random places of the default world.
#include <gtest/gtest.h>

#include <cstdio>
#include <map>
#include <string>

#include "count_of.hpp"
#include "goshawk/closed_loop/flight_lab.hpp"
#include "growing_world.hpp"

namespace goshawk::goals {
namespace {

using closed_loop::FlightLab;

std::shared_ptr<const VoxelGrid> default_map() {
  return GrowingWorld(worlds::default_world()).map();
}

struct Tally {
  int sent = 0;
  int dropped = 0;
  int stuck = 0;
  std::map<std::string, int> reasons;
};

// A first goal from rest, and a second at a random moment of that flight.
void interrupt(FlightLab& lab, Random& random, Tally& tally) {
  ASSERT_TRUE(lab.goal(lab.random_place()));
  ASSERT_TRUE(lab.run(20.0, [&] { return lab.moves() || lab.settled(); }));
  const double wait_s = random.uniform(0.0, 4.0);
  lab.run(wait_s, [&] { return !lab.moves(); });
  if (!lab.moves()) return;
  ++tally.sent;
  ASSERT_TRUE(lab.goal(lab.random_place()));
  if (!lab.run(60.0, [&] { return lab.settled(); })) {
    ++tally.stuck;
  } else if (lab.state().state != navigator::State::arrived) {
    ++tally.dropped;
    ++tally.reasons[std::string(to_string(lab.state().reason.code))];
    std::printf("%s\n", lab.state().reason.message.c_str());
  }
  lab.run(30.0, [&] { return !lab.moves(); });
}

TEST(GoalsInFlight, NoneIsDropped) {
  const int goals = count_of("GOSHAWK_GOALS", 60);
  Random random(7);
  FlightLab lab(default_map(), 11);
  Tally tally;
  const double begin_s = lab.now_s();
  while (tally.sent < goals) ASSERT_NO_FATAL_FAILURE(interrupt(lab, random, tally));
  std::printf(
      "%d goals in flight: %d dropped, %d stuck; %d plans, %d commits, %zu refused, "
      "%zu lost, largest error %.3f m, fastest %.3f m/s, %d ms of contact, %.0f s flown\n",
      tally.sent, tally.dropped, tally.stuck, lab.plans(), lab.commits(), lab.refusals.size(),
      lab.losses.size(), lab.max_error_m(), lab.max_speed_m_s(), lab.contacts(),
      lab.now_s() - begin_s);
  for (const auto& loss : lab.losses) std::printf("  lost: %s\n", loss.message.c_str());
  for (const auto& [code, count] : tally.reasons) std::printf("  %s: %d\n", code.c_str(), count);
  EXPECT_EQ(tally.dropped, 0);
  EXPECT_EQ(tally.stuck, 0);
  EXPECT_EQ(lab.contacts(), 0);
  EXPECT_LT(lab.max_error_m(), kTrackingMargin_m);
  EXPECT_TRUE(lab.losses.empty());
}

// A new goal every half second, to and fro or anywhere, whatever the vehicle does at the time.
TEST(GoalsInFlight, NoSequenceOfCommitsTakesTheVehicleOutOfItsMargin) {
  const int sequences = count_of("GOSHAWK_SEQUENCES", 30);
  Random random(8);
  double worst_m = 0.0;
  int commits = 0;
  std::size_t lost = 0;
  for (int k = 0; k < sequences; ++k) {
    SCOPED_TRACE(k);
    FlightLab lab(default_map(), std::uint64_t(k) + 100);
    const Vec3 sides[2] = {lab.random_place(), lab.random_place()};
    const bool alternates = random.chance(0.5);
    for (int i = 0; i < 10; ++i) {
      ASSERT_TRUE(lab.goal(alternates ? sides[i % 2] : lab.random_place()));
      lab.run(0.5);
    }
    lab.run(30.0, [&] { return lab.settled(); });
    EXPECT_EQ(lab.state().state, navigator::State::arrived);
    EXPECT_EQ(lab.contacts(), 0);
    worst_m = std::max(worst_m, lab.max_error_m());
    commits += lab.commits();
    lost += lab.losses.size();
  }
  std::printf("%d sequences, %d commits: %zu lost, largest error %.4f m\n", sequences, commits,
              lost, worst_m);
  EXPECT_LT(worst_m, kTrackingMargin_m);
  EXPECT_EQ(lost, 0u);
}

}  // namespace
}  // namespace goshawk::goals
