#include "mesh_raster.hpp"

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include <cmath>

#include "goshawk/core/random.hpp"

namespace goshawk::map_server {
namespace {

using Triangle = std::array<Vec3, 3>;

// By separating axes (Akenine-Moeller 2001): the 13 directions along which a triangle and a cube can
// be told apart. How far apart they are along the best of them; negative: they overlap by so much.
double gap(const Triangle& t, const Vec3& centre, double half) {
  std::vector<Vec3> axes{Vec3::UnitX(), Vec3::UnitY(), Vec3::UnitZ()};
  const Vec3 edges[3] = {t[1] - t[0], t[2] - t[1], t[0] - t[2]};
  axes.push_back(edges[0].cross(edges[1]));
  for (const Vec3& edge : edges) {
    for (int a = 0; a < 3; ++a) axes.push_back(edge.cross(Vec3::Unit(a)));
  }
  double widest = -HUGE_VAL;
  for (Vec3 axis : axes) {
    if (axis.norm() < 1e-9) continue;
    axis.normalize();
    const double reach = half * axis.cwiseAbs().sum();
    double lo = HUGE_VAL, hi = -HUGE_VAL;
    for (const Vec3& p : t) {
      lo = std::min(lo, axis.dot(p - centre));
      hi = std::max(hi, axis.dot(p - centre));
    }
    widest = std::max(widest, std::max(lo - reach, -reach - hi));
  }
  return widest;
}

constexpr Index3 kSize{14, 9, 11};

void expect_exact(const Triangle& t) {
  BitGrid occupied(kSize, true);
  rasterise(t, occupied);
  for (int z = 0; z < kSize.z; ++z) {
    for (int y = 0; y < kSize.y; ++y) {
      for (int x = 0; x < kSize.x; ++x) {
        const double apart = gap(t, Vec3(x + 0.5, y + 0.5, z + 0.5), 0.5);
        if (std::abs(apart) < 1e-5) continue;  // it touches: up to the rule for faces
        ASSERT_EQ(occupied.get({x, y, z}), apart < 0.0) << to_text(Index3{x, y, z}) << " " << apart;
      }
    }
  }
}

TEST(Rasterise, SetsExactlyTheVoxelsThatATrianglePassesThrough) {
  Random random(61);
  for (int n = 0; n < 3000; ++n) {
    Triangle t;
    const double size = random.chance(0.3) ? 1.0 : random.chance(0.5) ? 6.0 : 40.0;
    const Vec3 middle(random.uniform(0, 14), random.uniform(0, 9), random.uniform(0, 11));
    for (Vec3& p : t) {
      p = middle + size * Vec3(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
    }
    const int kind = random.below(6);
    if (kind == 0) t[2] = t[1];                           // a line
    if (kind == 1) t[1] = t[2] = t[0];                    // a point
    if (kind == 2) t[1].z() = t[2].z() = t[0].z();        // level
    if (kind == 3) t[2] = t[0] + 0.3 * (t[1] - t[0]);     // no area
    ASSERT_NO_FATAL_FAILURE(expect_exact(t));
  }
}

TEST(Rasterise, LosesNoPointOfATriangle) {
  Random random(62);
  for (int n = 0; n < 2000; ++n) {
    Triangle t;
    for (Vec3& p : t) {
      // On the raster, in part: corners, edges and faces of voxels.
      const auto value = [&](int most) {
        return random.chance(0.5) ? double(random.below(most + 1)) : random.uniform(0.0, most);
      };
      p = Vec3(value(14), value(9), value(11));
    }
    BitGrid occupied(kSize, true);
    rasterise(t, occupied);
    for (int k = 0; k < 200; ++k) {
      double u = random.uniform(), v = random.uniform();
      if (u + v > 1.0) u = 1.0 - u, v = 1.0 - v;
      const Vec3 p = t[0] + u * (t[1] - t[0]) + v * (t[2] - t[0]);
      const Vec3 f = (p.array() + 1e-6).floor();
      const Index3 i{int(f.x()), int(f.y()), int(f.z())};
      ASSERT_TRUE(!occupied.contains(i) || occupied.get(i)) << to_text(p);
    }
  }
}

TEST(Rasterise, AFaceBetweenTwoLayersGoesToTheUpperOneAsAPointDoes) {
  BitGrid occupied(kSize, true);
  rasterise({Vec3(5, 1, 1), Vec3(5, 7, 1), Vec3(5, 1, 9)}, occupied);
  EXPECT_TRUE(occupied.get({5, 2, 2}));
  EXPECT_FALSE(occupied.get({4, 2, 2}));
  BitGrid nearly(kSize, true);  // 2.5 / 0.1 is not 25
  const double x = 5.0 - 1e-12;
  rasterise({Vec3(x, 1, 1), Vec3(x, 7, 1), Vec3(x, 1, 9)}, nearly);
  EXPECT_EQ(nearly, occupied);
}

TEST(Rasterise, LeavesOutWhatIsOutsideAndBearsHugeTriangles) {
  BitGrid occupied(kSize, true);
  rasterise({Vec3(-5, -5, -5), Vec3(-1, -5, -5), Vec3(-5, -1, -2)}, occupied);
  rasterise({Vec3(20, 1, 1), Vec3(25, 1, 1), Vec3(20, 5, 5)}, occupied);
  EXPECT_EQ(occupied.count(), 0);
  rasterise({Vec3(-1e12, -1e12, 3.5), Vec3(3e12, -1e12, 3.5), Vec3(-1e12, 3e12, 3.5)}, occupied);
  EXPECT_EQ(occupied.count(), kSize.x * kSize.y);
  rasterise({Vec3(-1e300, 0, 0), Vec3(1e300, 1e300, 0), Vec3(0, 0, 1e300)}, occupied);
}

}  // namespace
}  // namespace goshawk::map_server
