#include "goshawk/sensors/solid_world.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace goshawk::sensors {
namespace {

constexpr int kLeaf = 2;  // parts
constexpr double kForever = std::numeric_limits<double>::infinity();

/// The part of a ray inside of something convex, and the normal where it begins.
struct Chord {
  double in = -kForever, out = kForever;  // [m] along the ray
  Vec3 normal = Vec3::Zero();             // of length 1

  bool any() const { return in <= out && out >= 0.0; }
  void cut(double from, double to, const Vec3& face_normal) {
    if (from > in) in = from, normal = face_normal;
    out = std::min(out, to);
  }
};

void cut_slab(Chord& chord, double origin, double slope, double half, const Vec3& axis) {
  if (slope == 0.0) {
    if (std::abs(origin) > half) chord.out = -kForever;
    return;
  }
  const double a = (-half - origin) / slope, b = (half - origin) / slope;
  chord.cut(std::min(a, b), std::max(a, b), axis);
}

// x^2 + y^2 <= radius^2
void cut_tube(Chord& chord, const Vec3& o, const Vec3& d, double radius) {
  const double a = d.x() * d.x() + d.y() * d.y();
  const double c = o.x() * o.x() + o.y() * o.y() - radius * radius;
  if (a == 0.0) {
    if (c > 0.0) chord.out = -kForever;
    return;
  }
  const double b = o.x() * d.x() + o.y() * d.y();
  const double square = b * b - a * c;
  if (square < 0.0) {
    chord.out = -kForever;
    return;
  }
  const double root = std::sqrt(square);
  const double in = (-b - root) / a;
  chord.cut(in, (-b + root) / a, Vec3(o.x() + in * d.x(), o.y() + in * d.y(), 0.0) / radius);
}

Chord chord_of(Solid::Kind kind, const Vec3& half, const Vec3& o, const Vec3& d) {
  Chord chord;
  cut_slab(chord, o.z(), d.z(), half.z(), Vec3::UnitZ());
  if (kind == Solid::Kind::cylinder) {
    cut_tube(chord, o, d, half.x());
  } else {
    cut_slab(chord, o.x(), d.x(), half.x(), Vec3::UnitX());
    cut_slab(chord, o.y(), d.y(), half.y(), Vec3::UnitY());
  }
  return chord;
}

/// @return whether the ray meets the box within most_m
bool meets(const Ray& ray, const Vec3& inverse, const Vec3& lower, const Vec3& upper,
           double most_m) {
  double in = 0.0, out = most_m;
  for (int a = 0; a < 3; ++a) {
    if (ray.direction[a] == 0.0) {
      if (ray.origin[a] < lower[a] || ray.origin[a] > upper[a]) return false;
      continue;
    }
    const double s = (lower[a] - ray.origin[a]) * inverse[a];
    const double t = (upper[a] - ray.origin[a]) * inverse[a];
    in = std::max(in, std::min(s, t));
    out = std::min(out, std::max(s, t));
  }
  return in <= out;
}

Status check(const Solid& s, std::size_t number) {
  const bool finite = is_finite(s.center) && is_finite(s.half) && s.rotation.coeffs().allFinite();
  if (finite && s.half.minCoeff() > 0.0 && std::abs(s.rotation.norm() - 1.0) < 1e-6) {
    return success();
  }
  return fail(ErrorCode::invalid_input,
              fmt::format("solid {} is not usable: its place and sizes must be finite, its sizes "
                          "above zero and its quaternion of length 1",
                          number));
}

}  // namespace

Result<SolidWorld> SolidWorld::create(std::vector<Solid> solids) {
  SolidWorld world;
  for (std::size_t i = 0; i < solids.size(); ++i) {
    if (auto status = check(solids[i], i); !status) return status.error();
    world.parts_.push_back(part_of(solids[i]));
  }
  if (!world.parts_.empty()) {
    world.nodes_.emplace_back();
    world.split(0, 0, int(world.parts_.size()));
  }
  return world;
}

SolidWorld::Part SolidWorld::part_of(const Solid& s) {
  const Eigen::Matrix3d turn = s.rotation.toRotationMatrix();
  const Vec3 reach = turn.cwiseAbs() * s.half;  // a cylinder's lies inside of its box's
  return {s.kind, s.center, s.half, turn.transpose(), s.center - reach, s.center + reach};
}

void SolidWorld::split(int node, int first, int count) {
  Vec3 lower = parts_[std::size_t(first)].lower, upper = parts_[std::size_t(first)].upper;
  Vec3 least = parts_[std::size_t(first)].center, most = least;
  for (int i = first; i < first + count; ++i) {
    const Part& p = parts_[std::size_t(i)];
    lower = lower.cwiseMin(p.lower), upper = upper.cwiseMax(p.upper);
    least = least.cwiseMin(p.center), most = most.cwiseMax(p.center);
  }
  nodes_[std::size_t(node)] = {lower, upper, first, count};
  if (count <= kLeaf) return;
  int axis = 0;
  (most - least).maxCoeff(&axis);
  const auto begin = parts_.begin() + first;
  std::nth_element(begin, begin + count / 2, begin + count, [axis](const Part& a, const Part& b) {
    return a.center[axis] < b.center[axis];
  });
  const int children = int(nodes_.size());
  nodes_.resize(nodes_.size() + 2);
  nodes_[std::size_t(node)].first = children;
  nodes_[std::size_t(node)].parts = 0;
  split(children, first, count / 2);
  split(children + 1, first + count / 2, count - count / 2);
}

void SolidWorld::cast(std::span<const Ray> rays, std::span<Hit> hits) const {
  for (std::size_t i = 0; i < rays.size(); ++i) hits[i] = cast_one(rays[i]);
}

Hit SolidWorld::cast_one(const Ray& ray) const {
  Hit best;
  if (nodes_.empty()) return best;
  const Vec3 inverse = ray.direction.cwiseInverse();
  int stack[kMaxDepth] = {0};
  for (int depth = 1; depth > 0;) {
    const Node& node = nodes_[std::size_t(stack[--depth])];
    const double most_m = std::min(best.range_m, ray.range_m);
    if (!meets(ray, inverse, node.lower, node.upper, most_m)) continue;
    if (node.parts == 0) {
      stack[depth++] = node.first;
      stack[depth++] = node.first + 1;
    }
    for (int i = node.first; i < node.first + node.parts; ++i) {
      const Hit hit = cast_at(parts_[std::size_t(i)], ray);
      if (hit.range_m < best.range_m) best = hit;
    }
  }
  return best;
}

Hit SolidWorld::cast_at(const Part& part, const Ray& ray) {
  const Vec3 origin = part.to_solid * (ray.origin - part.center);
  const Vec3 direction = part.to_solid * ray.direction;
  const Chord chord = chord_of(part.kind, part.half, origin, direction);
  if (!chord.any() || chord.in > ray.range_m) return {};
  if (chord.in <= 0.0) return {0.0, 1.0};  // it begins inside
  return {chord.in, std::abs(chord.normal.dot(direction))};
}

bool SolidWorld::contains(const Vec3& point) const {
  return std::any_of(parts_.begin(), parts_.end(), [&](const Part& part) {
    const Vec3 p = (part.to_solid * (point - part.center)).cwiseAbs();
    if (part.kind == Solid::Kind::cylinder) {
      return p.z() < part.half.z() && p.head<2>().squaredNorm() < part.half.x() * part.half.x();
    }
    return (p.array() < part.half.array()).all();
  });
}

}  // namespace goshawk::sensors
