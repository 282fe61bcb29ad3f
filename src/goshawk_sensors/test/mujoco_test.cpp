// Rays against MuJoCo's own ray casting, which shares no code with ours.

#include <gtest/gtest.h>
#include <mujoco/mujoco.h>

#include <cstring>
#include <memory>
#include <stdexcept>
#include <string>

#include "goshawk/sensors/joined_world.hpp"
#include "goshawk/sensors/solid_world.hpp"
#include "support.hpp"

namespace goshawk::sensors {
namespace {

/// A MuJoCo model as the world that a sensor sees: its geoms, as they stand.
class MujocoWorld : public World {
 public:
  explicit MujocoWorld(const std::string& geoms)
      : model_(load("<mujoco><worldbody>" + geoms + "</worldbody></mujoco>")),
        data_(mj_makeData(model_.get())) {
    mj_forward(model_.get(), data_.get());
  }

  void cast(std::span<const Ray> rays, std::span<Hit> hits) const override {
    for (std::size_t i = 0; i < rays.size(); ++i) {
      int geom = -1;
      const double range_m = mj_ray(model_.get(), data_.get(), rays[i].origin.data(),
                                    rays[i].direction.data(), nullptr, 1, -1, &geom);
      hits[i] = geom >= 0 && range_m <= rays[i].range_m ? Hit{range_m, 1.0} : Hit{};
    }
  }
  bool contains(const Vec3&) const override { return false; }

 private:
  struct Free {
    void operator()(mjModel* model) const { mj_deleteModel(model); }
    void operator()(mjData* data) const { mj_deleteData(data); }
  };

  static mjModel* load(const std::string& text) {
    mjVFS files;
    mj_defaultVFS(&files);
    if (mj_makeEmptyFileVFS(&files, "world.xml", int(text.size())) != 0) {
      throw std::runtime_error("no room for the model");
    }
    std::memcpy(files.filedata[mj_findFileVFS(&files, "world.xml")], text.data(), text.size());
    char error[300] = "";
    mjModel* model = mj_loadXML("world.xml", &files, error, sizeof error);
    mj_deleteVFS(&files);
    if (model == nullptr) throw std::runtime_error(error);
    return model;
  }

  std::unique_ptr<mjModel, Free> model_;
  std::unique_ptr<mjData, Free> data_;
};

std::string text_of(const Vec3& v) {
  return std::to_string(v.x()) + " " + std::to_string(v.y()) + " " + std::to_string(v.z());
}

std::string geom_of(const Solid& s) {
  const bool box = s.kind == Solid::Kind::box;
  const std::string size =
      box ? text_of(s.half) : std::to_string(s.half.x()) + " " + std::to_string(s.half.z());
  char q[200];
  std::snprintf(q, sizeof q, "%.17g %.17g %.17g %.17g", s.rotation.w(), s.rotation.x(),
                s.rotation.y(), s.rotation.z());
  return std::string("<geom type='") + (box ? "box" : "cylinder") + "' size='" + size + "' pos='" +
         text_of(s.center) + "' quat='" + q + "'/>";
}

constexpr double kMillimetre = 1e-3;

// Rays from random free places in all directions.
void expect_agreement(const World& ours, const World& truth, const Vec3& lower, const Vec3& upper,
                      int rays) {
  Random random(11);
  int met = 0;
  for (int i = 0; i < rays;) {
    const Vec3 origin = random_point(random, lower, upper);
    if (ours.contains(origin)) continue;  // MuJoCo sees geoms from inside, sensors do not
    const Ray ray{origin, random_direction(random), 30.0};
    const Hit hit = cast_one(ours, ray), should = cast_one(truth, ray);
    ASSERT_EQ(hit.any(), should.any()) << "ray " << i << " from " << to_text(origin);
    if (hit.any()) {
      ++met;
      EXPECT_NEAR(hit.range_m, should.range_m, kMillimetre) << "ray " << i;
    }
    ++i;
  }
  EXPECT_GT(met, rays / 10);
  EXPECT_LT(met, rays);
}

TEST(MujocoTruth, TenThousandRaysThroughVoxelsAgreeWithinAMillimetre) {
  Random random(5);
  const GridGeometry g{Vec3(-2.0, -1.0, 0.0), 0.25, {20, 16, 12}};
  const BitGrid grid = random_voxels(g.size, 0.05, random);
  std::string geoms;
  for (int z = 0; z < g.size.z; ++z) {
    for (int y = 0; y < g.size.y; ++y) {
      for (int x = 0; x < g.size.x; ++x) {
        if (!grid.get({x, y, z})) continue;
        const Vec3 lower = g.lower_corner({x, y, z});
        geoms += geom_of(Solid::box(lower, lower + Vec3::Constant(g.resolution_m)));
      }
    }
  }
  expect_agreement(VoxelWorld(g, grid, Boundary::open), MujocoWorld(geoms),
                   g.origin_map - Vec3::Constant(0.5), g.upper_corner_map() + Vec3::Constant(0.5),
                   10'000);
}

std::vector<Solid> random_solids(int count, std::string& geoms) {
  Random random(17);
  std::vector<Solid> solids;
  for (int i = 0; i < count; ++i) {
    Solid s;
    s.kind = i % 2 == 0 ? Solid::Kind::box : Solid::Kind::cylinder;
    s.center = random_point(random, Vec3(-5.0, -5.0, 0.0), Vec3(5.0, 5.0, 4.0));
    s.half = random_point(random, Vec3::Constant(0.1), Vec3::Constant(0.6));
    if (s.kind == Solid::Kind::cylinder) s.half.y() = s.half.x();
    s.rotation = Eigen::AngleAxisd(random.uniform(0.0, 3.0), random_direction(random));
    geoms += geom_of(s);
    solids.push_back(s);
  }
  return solids;
}

TEST(MujocoTruth, TenThousandRaysThroughTurnedBoxesAndCylindersAgreeWithinAMillimetre) {
  std::string geoms;
  const auto ours = SolidWorld::create(random_solids(60, geoms));
  ASSERT_TRUE(ours) << ours.error().message;
  expect_agreement(*ours, MujocoWorld(geoms), Vec3(-6.0, -6.0, -1.0), Vec3(6.0, 6.0, 5.0), 10'000);
}

TEST(MujocoTruth, ASensorSeesAPhysicsEnginesModelThroughTheSameInterface) {
  std::string geoms;
  const auto ours = SolidWorld::create(random_solids(40, geoms));
  const MujocoWorld truth(geoms);
  const auto parameters = perfect(Preset::mid360);
  auto first = Sensor::create(parameters), second = Sensor::create(parameters);
  Pose pose;
  pose.position_map = Vec3(0.0, 0.0, 8.0);  // above all of them
  pose.q_map_base = Eigen::AngleAxisd(kPi, Vec3::UnitX());
  const auto a = scans_at_rest(*first, *ours, 0.2, pose);
  const auto b = scans_at_rest(*second, truth, 0.2, pose);
  ASSERT_EQ(a.size(), 2U);
  ASSERT_EQ(b.size(), 2U);
  int valid = 0;
  for (std::size_t i = 0; i < a[0].returns.size(); ++i) {
    const Return &r = a[0].returns[i], &s = b[0].returns[i];
    ASSERT_EQ(r.valid, s.valid) << i;
    EXPECT_LT((r.point - s.point).norm(), kMillimetre) << i;
    valid += r.valid ? 1 : 0;
  }
  EXPECT_GT(valid, 500);
}

TEST(MujocoTruth, JoinedWorldsShowWhatComesFirst) {
  std::string first, second;
  auto a = std::make_shared<SolidWorld>(
      SolidWorld::create({Solid::cylinder(Vec3(2.0, 0.0, -1.0), 0.4, 3.0)}).value());
  auto b = std::make_shared<SolidWorld>(
      SolidWorld::create({Solid::box(Vec3(-3.0, -3.0, -0.2), Vec3(5.0, 3.0, -0.1))}).value());
  first = geom_of(Solid::cylinder(Vec3(2.0, 0.0, -1.0), 0.4, 3.0));
  second = geom_of(Solid::box(Vec3(-3.0, -3.0, -0.2), Vec3(5.0, 3.0, -0.1)));
  expect_agreement(JoinedWorld({a, b}), MujocoWorld(first + second), Vec3(-3.0, -3.0, -1.0),
                   Vec3(5.0, 3.0, 3.0), 2000);
}

}  // namespace
}  // namespace goshawk::sensors
