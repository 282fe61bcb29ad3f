#include "goshawk/obstacle_tracker/obstacle_tracker.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace goshawk::obstacle_tracker {
namespace {

constexpr std::int64_t kLongestPause_ns = 2'000'000'000;
constexpr double kFirstSpeed_m_s = 2.0;  // standard deviation of a new track's velocity
constexpr double kGate_m = 0.6;          // how far a told track's points may lie off its box
constexpr double kFarthestPlace_m = 1e6;
constexpr double kFarthest_m = 1.5;   // between a track and its cluster
constexpr double kGate = 16.0;        // squared standard deviations
constexpr double kShape_m = 0.2;      // one deviation of a centre whose shape is not known yet
constexpr double kSignificant = 2.5;  // standard deviations of a velocity that is none
constexpr int kHitsNeeded = 4;
constexpr double kLeastHalf_m = 0.1;  // a surface is seen: what is behind it is not
constexpr double kRest_m = 0.25;
constexpr double kMostCells = 32e6;  // 0.9 GB

EvidenceGrid::Parameters grid_of(const Config& c) {
  return {c.cell_m, c.range_m, c.height_m, c.settle_s, c.memory_s};
}

Status check(const Config& config) {
  ParameterFaults faults;
  describe(config, faults);
  if (auto status = faults.status(); !status) return status;
  const double cells = EvidenceGrid::cell_count(grid_of(config));
  if (cells <= kMostCells) return success();
  return fail(ErrorCode::invalid_parameter,
              fmt::format("range_m, height_m and cell_m need {:.0f} million cells, and {:.0f} "
                          "million are the most: choose larger cells or a smaller range",
                          1e-6 * cells, 1e-6 * kMostCells));
}

double gap_m(const Vec3& p, const Vec3& center, const Vec3& half) {
  return ((p - center).cwiseAbs() - half).cwiseMax(0.0).norm();
}

}  // namespace

Result<ObstacleTracker> ObstacleTracker::create(const Config& config) {
  if (auto status = obstacle_tracker::check(config); !status) return status.error();
  return ObstacleTracker(config);
}

ObstacleTracker::ObstacleTracker(const Config& c)
    : config_(c), grid_(grid_of(c)), clusters_(c.cell_m, c.vertical_gap_m) {}

void ObstacleTracker::reset() {
  const std::uint64_t next_id = next_id_;
  *this = ObstacleTracker(config_);
  next_id_ = next_id;  // no other thing has an id that was told
}

Status ObstacleTracker::check(const Scan& s) const {
  const auto wrong = [](const std::string& what) { return fail(ErrorCode::invalid_input, what); };
  const std::size_t n = s.points_map.size();
  if (s.origins_map.empty() || (s.origins_map.size() != 1 && s.origins_map.size() != n)) {
    return wrong("a scan needs the sensor's place: one, or one for each point");
  }
  if (!s.offsets_ns.empty() && s.offsets_ns.size() != n) {
    return wrong(fmt::format("a scan has {} points but {} times", n, s.offsets_ns.size()));
  }
  const Vec3& place = s.origins_map[0];
  if (!is_finite(place) || place.cwiseAbs().maxCoeff() > kFarthestPlace_m) {
    return wrong("the sensor's place is not finite, or beyond 1e6 m");
  }
  if (first_ns_ && s.stamp_ns == stamp_ns_) {
    return wrong("a scan has the same stamp as the one before it");
  }
  if (first_ns_ && s.stamp_ns < stamp_ns_) {
    return wrong(fmt::format("a scan is {:.3f} s older than the one before it",
                             1e-9 * double(stamp_ns_ - s.stamp_ns)));
  }
  return success();
}

Status ObstacleTracker::add(const Scan& scan) {
  if (auto status = check(scan); !status) return status;
  if (!first_ns_) first_ns_ = scan.stamp_ns;
  // Milliseconds of a cell count for 24 days.
  if ((scan.stamp_ns - *first_ns_) / 1'000'000 > 2'000'000'000) reset(), first_ns_ = scan.stamp_ns;
  if (scan.stamp_ns - stamp_ns_ > kLongestPause_ns) tracks_.clear();
  stamp_ns_ = scan.stamp_ns;
  read(scan);
  found_ = clusters_.group(points_);
  for (Cluster& c : found_) reach_down(c);
  associate(scan.origins_map[0]);
  const double now_s = 1e-9 * double(time_ns_ - *first_ns_);
  forget(now_s);
  tell(now_s);
  return success();
}

// Marks what is hit and what is free, and keeps the points of what may move.
void ObstacleTracker::read(const Scan& s) {
  const Vec3 center = s.origins_map[0];
  const double begin_s = 1e-9 * double(s.stamp_ns - *first_ns_);
  const auto time_s = [&](std::size_t i) {
    return begin_s + (s.offsets_ns.empty() ? 0.0 : 1e-9 * double(s.offsets_ns[i]));
  };
  const auto is_near = [&](const Vec3& p) {
    return is_finite(p) && (p - center).norm() <= config_.range_m && grid_.contains(p);
  };
  grid_.begin(center, std::int32_t((s.stamp_ns - *first_ns_) / 1'000'000));
  points_.clear();
  of_track_.assign(s.points_map.size(), 0);
  std::int64_t last_ns = 0;
  for (std::size_t i = 0; i < s.points_map.size(); ++i) {
    const Vec3& p = s.points_map[i];
    if (!s.offsets_ns.empty()) last_ns = std::max(last_ns, s.offsets_ns[i]);
    if (!is_near(p)) continue;
    // What belongs to something that moves leaves no trace among what stands.
    of_track_[i] = is_of_track(p, time_s(i)) && !grid_.is_beside_standing(p) ? 1 : 0;
    if (of_track_[i] == 0) grid_.hit(p);
  }
  time_ns_ = s.stamp_ns + last_ns;
  for (std::size_t i = 0; i < s.points_map.size(); ++i) {
    const Vec3& p = s.points_map[i];
    const Vec3& origin = s.origins_map[s.origins_map.size() == 1 ? 0 : i];
    // A sensor that is elsewhere in the same scan is a mistake; NaN fails as well.
    if (!is_finite(p) || !((origin - center).norm() <= config_.range_m)) continue;
    grid_.pass(origin, p);
    if (of_track_[i] != 0) {
      points_.push_back({p, time_s(i), true});
    } else if (is_near(p) && grid_.is_new(p) && !grid_.is_beside_standing(p)) {
      points_.push_back({p, time_s(i), grid_.stands_free(p)});
    }
  }
}

bool ObstacleTracker::is_of_track(const Vec3& p, double t_s) const {
  return std::ranges::any_of(tracks_, [&](const Track& t) {
    return t.told() &&
           gap_m(p, t.position() + (t_s - t.time_s) * t.velocity(), t.half_m) < 0.5 * kGate_m;
  });
}

// What is seen of a thing are its near faces: the far ones are as far behind as it was ever seen to
// be large, and its footprint is taken to be square.
Vec3 ObstacleTracker::half_of(const Cluster& c) const {
  Vec3 half = 0.5 * (c.upper_map - c.lower_map);
  half.x() = half.y() = std::max(half.x(), half.y());
  return half.cwiseMax(kLeastHalf_m);
}

Vec3 ObstacleTracker::center_of(const Cluster& c, const Vec3& half, const Vec3& origin) const {
  Vec3 center = 0.5 * (c.lower_map + c.upper_map);
  for (int a = 0; a < 2; ++a) {
    if (origin[a] < c.lower_map[a]) center[a] = c.lower_map[a] + half[a];
    if (origin[a] > c.upper_map[a]) center[a] = c.upper_map[a] - half[a];
  }
  return center;
}

std::optional<double> ObstacleTracker::cost(const Track& track, const Cluster& c,
                                            const Vec3& origin) const {
  const Vec3 half = half_of(c).cwiseMax(track.half_m);
  const Vec3 off = center_of(c, half, origin) - track.position();
  const double dt_s = c.t_s - track.time_s;
  double sum = 0.0;
  for (int a = 0; a < 3; ++a) {
    AxisFilter axis = track.axes[std::size_t(a)];
    axis.predict(std::max(0.0, dt_s), config_.acceleration_m_s2);
    const double d = off[a] - dt_s * axis.velocity;
    sum += d * d /
           (axis.pp + config_.position_noise_m * config_.position_noise_m + kShape_m * kShape_m);
  }
  const double apart = (off - dt_s * track.velocity()).norm();
  if (sum > kGate || apart > kFarthest_m) return std::nullopt;
  return sum;
}

// What stands on a floor is seen from some way above it: points beside the floor are left out.
void ObstacleTracker::reach_down(Cluster& c) const {
  Vec3 below = 0.5 * (c.lower_map + c.upper_map);
  for (int k = 1; k <= 3; ++k) {
    below.z() = c.lower_map.z() - k * config_.cell_m;
    if (!grid_.stands(below)) continue;
    const double top_m = (std::floor(below.z() / config_.cell_m) + 1.0) * config_.cell_m;
    c.lower_map.z() = std::min(c.lower_map.z(), top_m);
    return;
  }
}

// The nearest first, each track and each cluster once.
void ObstacleTracker::associate(const Vec3& origin) {
  matches_.clear();
  cluster_taken_.assign(found_.size(), 0);
  for (std::size_t t = 0; t < tracks_.size(); ++t) {
    tracks_[t].taken = false;
    for (std::size_t c = 0; c < found_.size(); ++c) {
      if (found_[c].points < config_.points_needed) continue;
      if (const auto d = cost(tracks_[t], found_[c], origin)) matches_.push_back({*d, t, c});
    }
  }
  std::ranges::sort(matches_, [](const Match& a, const Match& b) { return a.cost < b.cost; });
  for (const Match& m : matches_) {
    if (tracks_[m.track].taken || cluster_taken_[m.cluster] != 0) continue;
    tracks_[m.track].taken = true;
    cluster_taken_[m.cluster] = 1;
    update(tracks_[m.track], found_[m.cluster], origin);
  }
  for (std::size_t c = 0; c < found_.size(); ++c) {
    if (cluster_taken_[c] == 0) begin(found_[c], origin);
  }
}

void ObstacleTracker::update(Track& track, const Cluster& c, const Vec3& origin) {
  const Vec3 half = half_of(c);
  // Two things that touch look like one: then its shape says nothing.
  const bool merged = track.told() && (half.array() > 1.6 * track.half_m.array() + 0.3).any();
  if (!merged) track.half_m = half.cwiseMax(0.99 * track.half_m);
  const Vec3 center = center_of(c, track.half_m, origin);
  const double sd = merged ? kShape_m : config_.position_noise_m;
  const double dt_s = std::max(0.0, c.t_s - track.time_s);
  for (int a = 0; a < 3; ++a) {
    AxisFilter& axis = track.axes[std::size_t(a)];
    axis.predict(dt_s, config_.acceleration_m_s2);
    axis.update(center[a], sd);
  }
  track.time_s += dt_s;
  track.seen_s = track.time_s;
  ++track.hits;
  track.points += c.points;
  track.standing_free += c.standing_free;
  judge(track);
}

void ObstacleTracker::begin(const Cluster& c, const Vec3& origin) {
  const Vec3 half = half_of(c);
  const bool usable = c.points >= config_.points_needed && 2 * c.standing_free >= c.points &&
                      2.0 * half.maxCoeff() <= config_.largest_m;
  if (!usable) return;
  Track track;
  const Vec3 center = center_of(c, half, origin);
  for (int a = 0; a < 3; ++a) {
    track.axes[std::size_t(a)] =
        AxisFilter::at(center[a], config_.position_noise_m, kFirstSpeed_m_s);
  }
  track.half_m = half;
  track.birth_map = track.rest_map = center;
  track.time_s = track.seen_s = track.rest_s = track.birth_s = c.t_s;
  track.points = c.points;
  track.standing_free = c.standing_free;
  tracks_.push_back(track);
}

// A track is told once it moved farther and faster than noise explains.
void ObstacleTracker::judge(Track& track) {
  if ((track.position() - track.rest_map).norm() > kRest_m) {
    track.rest_map = track.position();
    track.rest_s = track.time_s;
  }
  if (track.told() || track.hits < kHitsNeeded) return;
  const double speed = track.velocity().norm();
  const double error = std::sqrt(std::max({track.axes[0].vv, track.axes[1].vv, track.axes[2].vv}));
  const bool moves = (track.position() - track.birth_map).norm() >= config_.confirm_distance_m &&
                     speed >= std::max(config_.confirm_speed_m_s, kSignificant * error) &&
                     2 * track.standing_free >= track.points &&
                     // It left the place where it was first seen.
                     grid_.is_free_since(track.birth_map, std::int32_t(1e3 * track.birth_s));
  if (moves) track.id = next_id_++;
}

void ObstacleTracker::forget(double now_s) {
  std::erase_if(tracks_, [&](const Track& t) {
    const double lost_s = t.told() ? config_.lost_s : std::min(config_.lost_s, 0.35);
    return now_s - t.seen_s > lost_s || t.seen_s - t.rest_s > config_.rest_s;
  });
}

void ObstacleTracker::tell(double now_s) {
  obstacles_.clear();
  for (const Track& t : tracks_) {
    if (!t.told()) continue;
    const double dt_s = std::max(0.0, now_s - t.time_s);
    TrackedObstacle o;
    double pp = 0.0, vv = 0.0;
    for (std::size_t a = 0; a < 3; ++a) {
      AxisFilter axis = t.axes[a];
      axis.predict(dt_s, config_.acceleration_m_s2);
      o.box.position_map[Eigen::Index(a)] = axis.position;
      o.box.velocity_map[Eigen::Index(a)] = axis.velocity;
      pp += axis.pp, vv += axis.vv;
    }
    o.box.id = t.id;
    o.box.half_m = t.half_m.array() + config_.margin_m;
    // What a shape hides moves its centre by a part of its size.
    const double shape = 0.25 * t.half_m.maxCoeff();
    o.box.position_error_m = std::sqrt(pp + shape * shape);
    o.box.velocity_error_m_s = std::sqrt(vv);
    o.bound_m = 2.0 * o.box.position_error_m + config_.agility_m_s * (now_s - t.seen_s);
    o.bound_rate_m_s = 2.0 * o.box.velocity_error_m_s + config_.agility_m_s;
    o.horizon_s = config_.horizon_s;
    o.top_speed_m_s = std::max(config_.top_speed_m_s, o.box.velocity_map.norm());
    obstacles_.push_back(o);
  }
}

}  // namespace goshawk::obstacle_tracker
