#include "goshawk/obstacle_tracker/evidence_grid.hpp"

#include <gtest/gtest.h>

#include "goshawk/core/random.hpp"

namespace goshawk::obstacle_tracker {
namespace {

const Vec3 kEye(0.1, 0.1, 1.1);

EvidenceGrid::Parameters small() {
  return {.cell_m = 0.25, .range_m = 8.0, .height_m = 6.0, .settle_s = 3.0, .memory_s = 60.0};
}

/// Rays from the eye to everywhere around a place, which end far behind it.
void look_around(EvidenceGrid& grid, const Vec3& place) {
  for (int i = -12; i <= 12; ++i) {
    for (int k = -12; k <= 12; ++k) {
      const Vec3 through = place + Vec3(0.0, 0.08 * i, 0.08 * k);
      grid.pass(kEye, kEye + 2.0 * (through - kEye));
    }
  }
}

TEST(EvidenceGrid, WhatComesWhereNothingWasIsNewUntilItSettles) {
  EvidenceGrid grid(small());
  const Vec3 place(3.1, 0.1, 1.1);
  grid.begin(kEye, 0);
  EXPECT_FALSE(grid.is_new(place));  // never seen
  look_around(grid, place);
  for (int ms = 100; ms <= 4000; ms += 100) {
    grid.begin(kEye, ms);
    grid.hit(place);
    EXPECT_EQ(grid.is_new(place), ms < 3100) << ms;
    EXPECT_EQ(grid.stands_free(place), ms < 3100) << ms;
  }
}

TEST(EvidenceGrid, WhatWasThereFromTheBeginningIsNotNew) {
  EvidenceGrid grid(small());
  const Vec3 place(3.1, 0.1, 1.1);
  for (int ms = 0; ms < 1000; ms += 100) {
    grid.begin(kEye, ms);
    grid.hit(place);
    grid.pass(kEye, place);
    EXPECT_FALSE(grid.is_new(place));
  }
  // It goes: after two scans that pass, its place is free.
  for (int ms = 1000; ms < 1200; ms += 100) {
    grid.begin(kEye, ms);
    look_around(grid, place);
  }
  grid.begin(kEye, 1300);
  grid.hit(place);
  EXPECT_TRUE(grid.is_new(place));
}

TEST(EvidenceGrid, WhatIsHitAndPassedByTurnsDoesNotStandFree) {
  EvidenceGrid grid(small());
  const Vec3 place(3.1, 0.1, 1.1);
  int ms = 0;
  grid.begin(kEye, ms);
  look_around(grid, place);
  for (int turn = 0; turn < 4; ++turn) {
    grid.begin(kEye, ms += 100);
    grid.hit(place);
    EXPECT_TRUE(grid.is_new(place));
    EXPECT_EQ(grid.stands_free(place), turn == 0) << turn;
    for (int k = 0; k < 2; ++k) {
      grid.begin(kEye, ms += 100);
      look_around(grid, place);
    }
  }
}

TEST(EvidenceGrid, NoiseIntoTheNextCellIsBesideWhatStands) {
  EvidenceGrid grid(small());
  const Vec3 place(3.1, 0.1, 1.1);
  for (int ms = 0; ms <= 3000; ms += 100) {
    grid.begin(kEye, ms);
    grid.hit(place);
    EXPECT_EQ(grid.is_beside_standing(place + Vec3(0.25, 0, -0.25)), ms == 3000);
  }
  EXPECT_TRUE(grid.stands(place));
  EXPECT_FALSE(grid.stands(place + Vec3(0.25, 0, 0)));
  EXPECT_FALSE(grid.is_beside_standing(place + Vec3(0.5, 0, 0)));
  EXPECT_FALSE(grid.is_free_since(place, 0));
  for (int ms = 3100; ms <= 3200; ms += 100) {
    grid.begin(kEye, ms);
    look_around(grid, place);
  }
  EXPECT_TRUE(grid.is_free_since(place, 3200));
  EXPECT_FALSE(grid.is_free_since(place, 3201));
}

TEST(EvidenceGrid, ASurfaceThatRaysGrazeDoesNotStandFree) {
  EvidenceGrid grid(small());
  grid.begin(kEye, 0);
  // Level rays through the cells of a floor at z = 0: below it nothing is seen.
  for (int i = -40; i <= 40; ++i) {
    for (int k = 0; k < 6; ++k) {
      const Vec3 from(-3.0, 0.05 * i + 0.1, 0.12 + 0.2 * k);
      grid.pass(from, from + Vec3(13.0, 0.0, 0.0));
    }
  }
  grid.begin(kEye, 100);
  const Vec3 floor(3.1, 0.1, 0.02);
  grid.hit(floor);
  EXPECT_TRUE(grid.is_new(floor));
  EXPECT_FALSE(grid.stands_free(floor));
}

TEST(EvidenceGrid, RaysSayNothingOfTheLastTwoCells) {
  EvidenceGrid grid(small());
  grid.begin(kEye, 0);
  grid.pass(kEye, kEye + Vec3(4.0, 0, 0));
  EXPECT_TRUE(grid.is_new(kEye + Vec3(3.2, 0, 0)));
  EXPECT_FALSE(grid.is_new(kEye + Vec3(3.7, 0, 0)));
  EXPECT_FALSE(grid.is_new(kEye + Vec3(4.0, 0, 0)));
}

// Truth: samples every millimetre along the ray.
TEST(EvidenceGrid, ARayPassesExactlyTheCellsOnItsWay) {
  Random random(3);
  for (int run = 0; run < 200; ++run) {
    EvidenceGrid grid(small());
    grid.begin(kEye, 0);
    const Vec3 to =
        kEye + Vec3(random.uniform(-5, 5), random.uniform(-5, 5), random.uniform(-2, 2));
    const double length = (to - kEye).norm();
    if (length < 1.0) continue;
    grid.pass(kEye, to);
    for (double s = 0.0; s < length - 0.5; s += 0.001) {
      ASSERT_TRUE(grid.is_new(kEye + s / length * (to - kEye))) << run << " at " << s;
    }
    const Vec3 beside = kEye + 0.5 * (to - kEye) + 0.75 * (to - kEye).unitOrthogonal();
    EXPECT_FALSE(grid.is_new(beside));
  }
}

TEST(EvidenceGrid, TheWindowFollowsAndForgetsWhatLeaves) {
  EvidenceGrid grid(small());
  const Vec3 place(3.1, 0.1, 1.1);
  grid.begin(kEye, 0);
  look_around(grid, place);
  grid.begin(kEye + Vec3(4, 0, 0), 100);
  EXPECT_TRUE(grid.is_new(place));
  for (const Vec3& away : {Vec3(15, 0, 0), Vec3(0, -15, 0), Vec3(0, 0, 9), Vec3(100, 50, -30)}) {
    EvidenceGrid other = grid;
    other.begin(kEye + away, 200);
    EXPECT_FALSE(other.contains(place));
    EXPECT_FALSE(other.is_new(place));
    // Cells that share the memory of those that left begin anew.
    for (double x = -7.0; x <= 7.0; x += 0.25) {
      for (double y = -7.0; y <= 7.0; y += 0.25) {
        for (double z = -2.5; z <= 2.5; z += 0.25) {
          ASSERT_FALSE(other.is_new(kEye + away + Vec3(x, y, z)));
        }
      }
    }
    other.begin(kEye, 300);
    EXPECT_FALSE(other.is_new(place));
  }
}

TEST(EvidenceGrid, MemoryEnds) {
  auto p = small();
  p.memory_s = 5.0;
  EvidenceGrid grid(p);
  const Vec3 place(3.1, 0.1, 1.1);
  grid.begin(kEye, 0);
  look_around(grid, place);
  grid.begin(kEye, 5000);
  EXPECT_TRUE(grid.is_new(place));
  grid.begin(kEye, 5001);
  EXPECT_FALSE(grid.is_new(place));
}

}  // namespace
}  // namespace goshawk::obstacle_tracker
