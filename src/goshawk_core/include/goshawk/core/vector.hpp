#pragma once

#include <Eigen/Core>
#include <string>

namespace goshawk {

using Vec3 = Eigen::Vector3d;

// How Eigen aligns a fixed-size type, and how it allocates a dynamic one, depends on what the
// compiler was told of the processor (-mavx2, -march=native). Public types hold what does not.
template <int Columns>
using Points3 = Eigen::Matrix<double, 3, Columns, Eigen::DontAlign>;  // one point a column
using Vec4 = Eigen::Matrix<double, 4, 1, Eigen::DontAlign>;

/// A voxel's index in a grid.
struct Index3 {
  int x = 0;
  int y = 0;
  int z = 0;
  friend bool operator==(const Index3&, const Index3&) = default;
  friend Index3 operator+(Index3 a, Index3 b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
  friend Index3 operator-(Index3 a, Index3 b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
};

inline bool is_finite(const Vec3& v) {
  return v.allFinite();
}

/// "(1.000, 2.000, 3.000)", for sentences
std::string to_text(const Vec3& p);
std::string to_text(Index3 i);

}  // namespace goshawk
