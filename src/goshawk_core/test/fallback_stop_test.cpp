#include "goshawk/core/fallback_stop.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>

namespace goshawk {
namespace {

// A quarter of a circle of 2 m, flown at ever slower speed: angle(t) runs to rest smoothly.
FlatState on_circle(double t_s, double duration_s) {
  const double x = std::clamp(t_s / duration_s, 0.0, 1.0);
  const double angle = 1.5 * (x - x * x * x + x * x * x * x / 2.0);
  const double rate = 1.5 * (1.0 - 3.0 * x * x + 2.0 * x * x * x) / duration_s;
  const double growth = 1.5 * (-6.0 * x + 6.0 * x * x) / (duration_s * duration_s);
  const Vec3 out(std::cos(angle), std::sin(angle), 0.0), along(-out.y(), out.x(), 0.0);
  return {2.0 * out, 2.0 * rate * along, 2.0 * (growth * along - rate * rate * out), Vec3::Zero()};
}

FallbackStop quarter(double duration_s, int steps) {
  FallbackStop stop{.step_s = duration_s / steps, .states = {}};
  for (int i = 0; i <= steps; ++i) stop.states.push_back(on_circle(stop.step_s * i, duration_s));
  return stop;
}

TEST(FallbackStop, IsTheCurveThatItsStatesLieOn) {
  const auto stop = quarter(1.6, 32);
  ASSERT_TRUE(stop.check()) << stop.check().error().message;
  EXPECT_DOUBLE_EQ(stop.duration_s(), 1.6);
  for (double t = 0.0; t <= 1.6; t += 0.003) {
    const FlatState truth = on_circle(t, 1.6);
    EXPECT_LT((stop.at(t).position - truth.position).norm(), 1e-6) << t;
    EXPECT_LT((stop.at(t).velocity - truth.velocity).norm(), 1e-4) << t;
    EXPECT_LT((stop.at(t).acceleration - truth.acceleration).norm(), 1e-2) << t;
  }
}

TEST(FallbackStop, BeginsWithItsFirstStateAndEndsAtRest) {
  const auto stop = quarter(1.6, 32);
  EXPECT_LT(largest_difference(stop.at(-0.5), stop.states.front()), 1e-12);
  for (const double t : {1.6, 1.7, 1e9}) {
    EXPECT_EQ(stop.at(t).position, stop.states.back().position);
    EXPECT_EQ(stop.at(t).velocity, Vec3::Zero());
  }
  const FallbackStop held{.step_s = 0.05, .states = {{.position = {1, 2, 3}}}};
  ASSERT_TRUE(held.check());
  for (const double t : {-0.5, 0.0, 1.0}) EXPECT_EQ(held.at(t).position, Vec3(1, 2, 3)) << t;
  EXPECT_EQ(held.nearest_time_s({0, 0, 0}, -1.0, 1.0), 0.0);
}

// The truth: brute force.
TEST(FallbackStop, FindsWhenItIsNearestToAPlace) {
  const auto stop = quarter(1.6, 32);
  for (double t = 0.02; t < 1.2; t += 0.013) {
    const Vec3 place = 1.03 * on_circle(t, 1.6).position;
    double least_m = HUGE_VAL;
    for (double s = 0.0; s <= 1.6; s += 1e-4) {
      least_m = std::min(least_m, (stop.at(s).position - place).norm());
    }
    const double found_s = stop.nearest_time_s(place, t - 0.3, t + 0.3);
    EXPECT_NEAR((stop.at(found_s).position - place).norm(), least_m, 1e-5) << t;
  }
  EXPECT_EQ(stop.nearest_time_s(on_circle(1.0, 1.6).position, 0.1, 0.4), 0.4) << "only within";
}

TEST(FallbackStop, IsRefusedIfItCannotBeFlown) {
  const double inf = std::numeric_limits<double>::infinity();
  const std::vector<std::pair<const char*, std::function<void(FallbackStop&)>>> spoilt{
      {"0 states", [](auto& s) { s.states.clear(); }},
      {"1001 states", [](auto& s) { s.states.resize(1001); }},
      {"its step is 0 s", [](auto& s) { s.step_s = 0.0; }},
      {"its step is nan s", [](auto& s) { s.step_s = std::nan(""); }},
      {"its step is 1e-300 s", [](auto& s) { s.step_s = 1e-300; }},
      {"its step is 11 s", [](auto& s) { s.step_s = 11.0; }},
      {"not finite", [&](auto& s) { s.states[3].velocity.y() = inf; }},
      {"not finite", [](auto& s) { s.states[4].position.z() = std::nan(""); }},
      {"beyond", [](auto& s) { s.states[5].position.x() = -1e300; }},
      {"beyond", [](auto& s) { s.states[6].acceleration.x() = 1e7; }},
      {"moves", [](auto& s) { s.states.back().velocity.x() = 0.1; }},
      {"moves", [](auto& s) { s.states.back().acceleration.z() = 0.1; }},
  };
  for (const auto& [words, spoil] : spoilt) {
    auto stop = quarter(1.6, 32);
    spoil(stop);
    const Status status = stop.check();
    ASSERT_EQ(status.code(), ErrorCode::invalid_input) << words;
    EXPECT_NE(status.error().message.find(words), std::string::npos) << status.error().message;
  }
}

}  // namespace
}  // namespace goshawk
