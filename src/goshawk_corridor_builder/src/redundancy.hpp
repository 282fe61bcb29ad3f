#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "separating_plane.hpp"

namespace goshawk::corridor_builder {

/// Finds the planes that are faces of their intersection. The local box is clipped by one plane
/// after the other; a plane that no vertex lies on at the end is not a face.
///
/// Vertices are rounded, so they only propose. A plane is left out only with a proof (Farkas): its
/// normal is a combination, with weights >= 0, of three kept normals, whose offsets add up to at
/// most its own plus a quarter of the margin that it keeps from obstacles. Without the proof it
/// stays, as every tight plane does: the answer may have a face too many, never one too few.
class RedundancyFilter {
 public:
  static constexpr int kMostPlanes = 128;  // further planes all stay

  /// @param planes the first six are the local box, in the order of PolytopeExpansion
  /// @param extent the local box is [0, extent] @param kept planes of the answer, in order
  void filter(std::span<const Plane> planes, const Vec3& extent, const Margins& margins,
              std::vector<Plane>& kept);

 private:
  using Mask = std::array<std::uint64_t, kMostPlanes / 64>;
  struct Vertex {
    Vec3 x = Vec3::Zero();
    Mask on = {};  // a bit for each plane that it lies on
    double height = 0.0;

    bool lies_on(std::size_t k) const { return (on[k / 64] >> (k % 64)) & 1U; }
    void put_on(std::size_t k) { on[k / 64] |= std::uint64_t{1} << (k % 64); }
  };

  void start(std::span<const Plane> planes);
  void clip(const Plane& plane, std::size_t index);
  bool follows_from_kept(std::span<const Plane> planes, std::size_t k, double far,
                         double tolerance) const;

  std::vector<Vertex> vertices_;
  std::vector<Vertex> next_;
  std::vector<unsigned char> face_;
};

}  // namespace goshawk::corridor_builder
