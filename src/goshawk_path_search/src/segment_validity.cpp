// The only file that sees FCL.
#include "goshawk/path_search/segment_validity.hpp"

#include <fcl/broadphase/broadphase_dynamic_AABB_tree.h>
#include <fcl/geometry/shape/box.h>
#include <fcl/geometry/shape/capsule.h>
#include <fcl/narrowphase/collision.h>
#include <fcl/narrowphase/collision_object.h>

#include <vector>

#include "goshawk/core/line_of_sight.hpp"

namespace goshawk::path_search {
namespace {

class GridValidity final : public SegmentValidity {
 public:
  explicit GridValidity(const BitGrid& blocked) : blocked_(blocked) {}
  bool is_free(const Vec3& a, const Vec3& b) const override { return line_is_free(blocked_, a, b); }

 private:
  const BitGrid& blocked_;
};

bool meets(fcl::CollisionObjectd* one, fcl::CollisionObjectd* other, void* found) {
  // Its own solver: libccd, the default, is coarse for shapes as thin as this.
  fcl::CollisionRequestd request;
  request.gjk_solver_type = fcl::GJKSolverType::GST_INDEP;
  fcl::CollisionResultd result;
  fcl::collide(one, other, request, result);
  *static_cast<bool*>(found) = result.isCollision();
  return result.isCollision();  // true: enough
}

class FclValidity final : public SegmentValidity {
 public:
  explicit FclValidity(const BitGrid& blocked) {
    add_runs(blocked);
    if (blocked.outside()) add_walls(blocked.size());
    std::vector<fcl::CollisionObjectd*> all;
    for (const auto& box : boxes_) all.push_back(box.get());
    tree_.registerObjects(all);
    tree_.setup();
  }

  bool is_free(const Vec3& a, const Vec3& b) const override {
    if (!a.allFinite() || !b.allFinite()) return false;
    const double length = (b - a).norm();
    fcl::Transform3d pose = fcl::Transform3d::Identity();
    pose.translation() = (a + b) / 2.0;
    if (length > 0.0) {
      pose.linear() = Eigen::Quaterniond::FromTwoVectors(Vec3::UnitZ(), b - a).toRotationMatrix();
    }
    fcl::CollisionObjectd capsule(std::make_shared<fcl::Capsuled>(kFclMargin, length), pose);
    bool found = false;
    tree_.collide(&capsule, &found, meets);
    return !found;
  }

 private:
  void add(const Vec3& lower, const Vec3& upper) {
    const Vec3 size = upper - lower;
    fcl::Transform3d pose = fcl::Transform3d::Identity();
    pose.translation() = (lower + upper) / 2.0;
    boxes_.push_back(std::make_unique<fcl::CollisionObjectd>(
        std::make_shared<fcl::Boxd>(size.x(), size.y(), size.z()), pose));
  }

  void add_runs(const BitGrid& blocked) {
    const Index3 n = blocked.size();
    for (int z = 0; z < n.z; ++z) {
      for (int y = 0; y < n.y; ++y) {
        for (int x = 0; x < n.x; ++x) {
          const int first = x;
          while (x < n.x && blocked.get({x, y, z})) ++x;
          if (x > first) add(Vec3(first, y, z), Vec3(x, y + 1, z + 1));
        }
      }
    }
  }

  void add_walls(Index3 n) {
    const Vec3 size(n.x, n.y, n.z);
    for (int axis = 0; axis < 3; ++axis) {
      Vec3 below = size + Vec3::Ones(), above = -Vec3::Ones();
      below[axis] = 0.0;
      above[axis] = size[axis];
      add(-Vec3::Ones(), below);
      add(above, size + Vec3::Ones());
    }
  }

  std::vector<std::unique_ptr<fcl::CollisionObjectd>> boxes_;
  fcl::DynamicAABBTreeCollisionManagerd tree_;
};

}  // namespace

std::unique_ptr<SegmentValidity> make_grid_validity(const BitGrid& blocked) {
  return std::make_unique<GridValidity>(blocked);
}

std::unique_ptr<SegmentValidity> make_fcl_validity(const BitGrid& blocked) {
  return std::make_unique<FclValidity>(blocked);
}

}  // namespace goshawk::path_search
