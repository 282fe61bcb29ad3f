#include "path_wrapper.hpp"

#include <algorithm>
#include <cmath>

namespace goshawk::corridor_builder {
namespace {

constexpr double kShareAtEnds = 0.9;  // of the room around start and goal that polytopes leave
constexpr double kRounding = 1e-6;    // [voxel edges] of planes that were made to leave a ball

// The distance to the nearest blocked cube, at most half a voxel. The map's outside is blocked.
double free_radius(const BitGrid& occupied, const Vec3& p) {
  const Vec3 f = p.array().floor();
  const Index3 i{int(f.x()), int(f.y()), int(f.z())};
  double least = kHalfVoxel * kHalfVoxel;
  for (int k = 0; k < 27; ++k) {
    const Index3 j = i + Index3{k % 3 - 1, k / 3 % 3 - 1, k / 9 - 1};
    if (!occupied.test(j)) continue;
    const Vec3 lower(j.x, j.y, j.z);
    const Vec3 way = p.cwiseMax(lower).cwiseMin((lower.array() + 1.0).matrix()) - p;
    least = std::min(least, way.squaredNorm());
  }
  return std::sqrt(least);
}

Vec3 centre(const Index3& i) {
  return {i.x + 0.5, i.y + 0.5, i.z + 0.5};
}

Segment between(const PathPoint& p, const PathPoint& q) {
  return {p.p_grid, q.p_grid, {p.wanted, q.wanted}, {p.needed, q.needed}};
}

}  // namespace

void split_path(const GridGeometry& geometry, std::span<const Vec3> path, double max_segment_m,
                std::vector<PathPoint>& points) {
  points.clear();
  auto add = [&](const Vec3& p, std::size_t segment) {
    const Vec3 at = geometry.to_grid(p);
    points.push_back({.p_map = p, .p_grid = at, .given_grid = at, .segment = int(segment)});
  };
  add(path[0], 0);
  for (std::size_t i = 0; i + 1 < path.size(); ++i) {
    const double length = (path[i + 1] - path[i]).norm();
    const bool last = i + 2 == path.size();
    if (length == 0.0 && !(last && points.size() == 1)) continue;
    points.back().segment = int(i);
    const double parts = std::max(1.0, std::ceil(length / max_segment_m));
    for (double k = 1.0; k < parts; ++k) add(path[i] + (k / parts) * (path[i + 1] - path[i]), i);
    add(path[i + 1], i);
  }
  points.back().p_map = path.back();
}

std::optional<Blockage> PathWrapper::wrap(const VoxelGrid& grown, const ObstacleLayers& map,
                                          const Margins& margins, std::vector<PathPoint>& points,
                                          Chain& chain) {
  grown_ = &grown;
  map_ = &map;
  margins_ = margins;
  points_ = &points;
  measure_rooms(grown.grown, points);
  chain.clear();
  chain.waypoints_map.push_back(points.front().p_map);
  for (std::size_t i = 0; i + 1 < points.size();) {
    const Step step = wrap_one(i, chain);
    if (step == Step::blocked) return Blockage{points[i].segment, blocked_grid_};
    if (step == Step::done) i = join(i + 1, chain);
  }
  return std::nullopt;
}

// The last polytope of the chain joins the one before. @param i where its segment ends
// @return the point to go on from
std::size_t PathWrapper::join(std::size_t i, Chain& chain) {
  const std::size_t last = chain.size() - 1;
  if (last > 0) chain.overlaps.push_back(chebyshev_ball(chain[last - 1], chain[last]));
  if (config_.drop_covered) i = covered_until(chain[last], i);
  chain.waypoints_map.push_back((*points_)[i].p_map);
  return i;
}

// Polytopes that meet at a waypoint must share a ball there; start and goal may lie at an obstacle.
void PathWrapper::measure_rooms(const BitGrid& occupied, std::vector<PathPoint>& points) const {
  for (PathPoint& point : points) {
    const double free = free_radius(occupied, point.p_grid);
    const bool end = &point == &points.front() || &point == &points.back();
    const bool roomy = free >= kHalfVoxel;
    point.wanted = roomy ? free : kShareAtEnds * free;
    point.needed = roomy && !end ? kHalfVoxel : 0.0;
  }
}

PathWrapper::Step PathWrapper::wrap_one(std::size_t i, Chain& chain) {
  const PathPoint p = (*points_)[i];
  const PathPoint q = (*points_)[i + 1];
  const bool no_ball = i + 2 < points_->size() && q.needed == 0.0;  // around the next waypoint
  if (no_ball && config_.bend_path && !p.settled) return move_waypoint(i, chain);
  // A single polytope has no neighbour to share a ball with.
  const bool may_bend = config_.bend_path && !p.settled && points_->size() > 2;
  const Separation result = build(p, q, may_bend, chain);
  if (result == Separation::roomy) return Step::done;
  if (result == Separation::blocked && (!p.moved || p.settled)) return Step::blocked;
  if (!may_bend && result == Separation::thin) return Step::done;
  // A waypoint that was moved may lie behind an obstacle, but not from a path that is bent.
  bend(i, between(p, q));
  return Step::bent;
}

// Appends the polytope of pq, unless it is blocked, or thin and that is to stop it.
Separation PathWrapper::build(const PathPoint& p, const PathPoint& q, bool stop_when_thin,
                              Chain& chain) {
  const Segment segment = between(p, q);
  const Separation result =
      segment_polytope_.build(*map_, segment, stop_when_thin, margins_, chain.append());
  if (result == Separation::roomy) return result;
  if (result == Separation::blocked || stop_when_thin) chain.drop_last();
  Segment here = segment;
  here.p -= segment_polytope_.base();
  here.q -= segment_polytope_.base();
  const double t = nearest_parameter(segment_polytope_.in_the_way(), here);
  blocked_grid_ = segment.p + t * (segment.q - segment.p);
  return result;
}

// No ball of half a voxel is free around the next waypoint: the centre of its voxel takes its
// place.
PathWrapper::Step PathWrapper::move_waypoint(std::size_t i, Chain& chain) {
  PathPoint p = (*points_)[i];
  PathPoint q = (*points_)[i + 1];
  p.p_grid = p.given_grid;
  p.wanted = p.needed = q.wanted = q.needed = 0.0;
  if (build(p, q, false, chain) == Separation::blocked) return Step::blocked;
  chain.drop_last();
  (*points_)[i].settled = true;
  if (!walk(i)) return Step::bent;
  Segment segment = between((*points_)[i], q);
  segment.p -= segment_polytope_.base();
  segment.q -= segment_polytope_.base();
  if (!detour_.along(segment_polytope_.obstacles(), segment, centres_, true, between_)) {
    return Step::bent;
  }
  PathPoint& waypoint = (*points_)[i + 1];
  waypoint.moved = true;
  waypoint.p_grid = centre(voxels_.back());
  waypoint.p_map = grown_->geometry.center(voxels_.back());
  waypoint.wanted = waypoint.needed = kHalfVoxel;
  between_.pop_back();  // the waypoint
  insert(i);
  return Step::bent;
}

void PathWrapper::bend(std::size_t i, const Segment& segment) {
  const Vec3 base = segment_polytope_.base();
  const Index3 size = grown_->geometry.size;
  const Bounds map{-base, Vec3(size.x, size.y, size.z) - base};
  Segment here = segment;
  here.p -= base;
  here.q -= base;
  const BoxSet& obstacles = segment_polytope_.obstacles();
  (*points_)[i].settled = true;
  if (detour_.push_away(obstacles, map, here, between_) && !between_.empty()) return insert(i);
  if (walk(i) && detour_.along(obstacles, here, centres_, false, between_)) return insert(i);
}

// The centres of free voxels along the path as given, relative to the obstacles' base.
bool PathWrapper::walk(std::size_t i) {
  const PathPoint& p = (*points_)[i];
  voxels_.clear();
  if (p.moved) {
    const Vec3 f = p.p_grid.array().floor();
    voxels_.push_back({int(f.x()), int(f.y()), int(f.z())});
  }
  const Vec3& goal = (*points_)[i + 1].given_grid;
  if (!walk_.append(grown_->grown, p.given_grid, goal, voxels_)) return false;
  centres_.clear();
  for (const Index3& v : voxels_) centres_.push_back(centre(v) - segment_polytope_.base());
  return true;
}

// The points between i and the next one.
void PathWrapper::insert(std::size_t i) {
  PathPoint point;
  point.segment = (*points_)[i].segment;
  point.wanted = point.needed = kHalfVoxel;
  point.settled = true;
  for (const Vec3& p : between_) {
    point.p_grid = point.given_grid = p + segment_polytope_.base();
    if ((point.p_grid - (*points_)[i].p_grid).norm() < 1e-9) continue;
    point.p_map = grown_->geometry.origin_map + grown_->geometry.resolution_m * point.p_grid;
    points_->insert(points_->begin() + std::ptrdiff_t(++i), point);
  }
}

// Parts of the path that a polytope holds, with the balls around their ends, need none of their
// own. @return the point where it is left
std::size_t PathWrapper::covered_until(const Polytope& polytope, std::size_t end) const {
  const double resolution_m = grown_->geometry.resolution_m;
  for (; end + 1 < points_->size(); ++end) {
    const PathPoint& next = (*points_)[end + 1];
    const bool goal = end + 2 == points_->size();
    const double ball = (goal ? next.wanted : kHalfVoxel) - kRounding;
    if (-polytope.violation(next.p_map) < ball * resolution_m) break;
  }
  return end;
}

}  // namespace goshawk::corridor_builder
