#include "goshawk/league/scene.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "goshawk/core/random.hpp"

namespace goshawk::league {
namespace {

/// Is a point inside a solid? By its definition.
bool inside(const Solid& s, const Vec3& p) {
  const Vec3 off = (p - s.center_map).cwiseAbs(), half = 0.5 * s.size_m;
  if ((off.array() > half.array()).any()) return false;
  return s.is_box || off.head<2>().norm() <= half.x();
}

bool inside_any(const Scene& scene, const Vec3& p) {
  for (const Solid& s : scene.solids) {
    if (inside(s, p)) return true;
  }
  return false;
}

TEST(Scene, EachHasAStartAndAGoalWithRoomForTheBody) {
  for (const auto& name : scene_names()) {
    SCOPED_TRACE(name);
    for (std::uint64_t seed = 0; seed < 5; ++seed) {
      const auto scene = make_scene(name, seed);
      ASSERT_TRUE(scene) << scene.error().message;
      EXPECT_EQ(scene->name, name);
      EXPECT_TRUE(scene->limits.check());
      for (const Vec3& end : {scene->start, scene->goal}) {
        EXPECT_TRUE(scene->box.holds(end));
        for (const Solid& s : scene->solids) {
          const Vec3 off = ((end - s.center_map).cwiseAbs() - 0.5 * s.size_m).cwiseMax(0.0);
          EXPECT_TRUE(off.norm() > 0.2 || (!s.is_box && !inside(s, end))) << to_text(end);
        }
      }
    }
  }
}

TEST(Scene, AnUnknownNameIsRefusedWithThoseThatAre) {
  const auto scene = make_scene("forest_dense", 0);
  ASSERT_FALSE(scene);
  EXPECT_NE(scene.error().message.find("forest_hard"), std::string::npos);
}

TEST(Scene, SeedsChangeGoalsAndOurOwnWorlds) {
  EXPECT_NEAR(make_scene("standardized", 0)->goal.y(), -3.0, 1e-12);
  EXPECT_NEAR(make_scene("standardized", 60)->goal.y(), 3.0, 1e-12);
  EXPECT_NE(make_scene("exits", 0)->goal, make_scene("exits", 1)->goal);
  EXPECT_NE(make_scene("office", 0)->solids.size(), make_scene("office", 1)->solids.size());
}

// At random places: a voxel is an obstacle if a point of it is, up to solids that only graze it.
TEST(Scene, TheKnownMapShowsTheSolids) {
  Random random(3);
  for (const char* name : {"standardized", "exits", "office", "thin_5"}) {
    SCOPED_TRACE(name);
    const auto scene = make_scene(name, 1).value();
    const auto map = known_map(scene, 0.2, 0.2).value();
    ASSERT_TRUE(map->check());
    int blocked = 0, seen = 0;
    for (int k = 0; k < 20'000; ++k) {
      Vec3 p;
      for (int i = 0; i < 3; ++i) {
        p[i] = random.uniform(scene.box.lower_map[i], scene.box.upper_map[i]);
      }
      const Index3 voxel = *map->geometry.index_of(p);
      if (inside_any(scene, p)) {
        ++blocked;
        EXPECT_TRUE(map->raw.get(voxel)) << to_text(p);
      }
      if (!map->raw.get(voxel)) continue;
      bool any = false;
      for (int z = 0; z <= 10; ++z) {
        for (int y = 0; y <= 10; ++y) {
          for (int x = 0; x <= 10 && !any; ++x) {
            any = inside_any(scene, map->geometry.lower_corner(voxel) + 0.02 * Vec3(x, y, z));
          }
        }
      }
      ++seen;
      EXPECT_TRUE(any) << to_text(p);
      if (seen > 300) break;
    }
    EXPECT_GT(blocked, 5);
  }
}

TEST(Scene, TheSensorsWorldIsThatOfTheSolids) {
  Random random(8);
  const auto scene = make_scene("exits", 2).value();
  const auto world = to_sensor_world(scene.solids).value();
  for (int k = 0; k < 5'000; ++k) {
    const Vec3 p(random.uniform(0.0, 48.0), random.uniform(-10.0, 10.0), random.uniform(0.0, 3.0));
    EXPECT_EQ(world->contains(p), inside_any(scene, p)) << to_text(p);
  }
}

}  // namespace
}  // namespace goshawk::league
