#include "goshawk/map_server/sensor_check.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace goshawk::map_server {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr int kAzimuths = 120, kElevations = 60;  // directions of 3 degrees
constexpr double kMostOfClouds = 0.8;

/// What came from one direction.
struct Direction {
  std::int64_t returns = 0;
  std::int64_t clouds_near = 0;  // with a return within the body's reach
  std::int64_t near = 0;
  double farthest_near_m = 0.0;
  std::int64_t last_near_cloud = -1;
};

class Sphere {
 public:
  Sphere() : directions_(std::size_t(kAzimuths) * kElevations) {}

  void add(const Vec3& p, double range_m, std::int64_t cloud, double body_reach_m) {
    Direction& d = at(azimuth_of(p), elevation_of(p, range_m));
    ++d.returns;
    if (range_m > body_reach_m) return;
    ++d.near;
    d.farthest_near_m = std::max(d.farthest_near_m, range_m);
    if (d.last_near_cloud != cloud) ++d.clouds_near;
    d.last_near_cloud = cloud;
  }

  void tell_body(std::int64_t clouds, std::int64_t returns, SensorReport& report) const {
    std::int64_t on_body = 0;
    for (const Direction& d : directions_) {
      if (double(d.clouds_near) < kMostOfClouds * double(clouds)) continue;
      on_body += d.near;
      report.body_reach_m = std::max(report.body_reach_m, d.farthest_near_m);
    }
    report.body_share = double(on_body) / double(returns);
  }

  std::vector<Sector> blind() const {
    std::vector<Sector> sectors;
    for (int a = 0; a < kAzimuths; ++a) {
      if (sees(a)) continue;
      const double from = -kPi + 2.0 * kPi * a / kAzimuths, to = from + 2.0 * kPi / kAzimuths;
      if (!sectors.empty() && sectors.back().to_rad > from - 1e-9) {
        sectors.back().to_rad = to;
      } else {
        sectors.push_back({from, to});
      }
    }
    return joined_behind(std::move(sectors));
  }

  /// [sr] of all directions that something came from.
  double solid_angle() const {
    double sum = 0.0;
    for (int e = 0; e < kElevations; ++e) {
      const double lower = -kPi / 2 + kPi * e / kElevations;
      const double belt =
          2.0 * kPi / kAzimuths * (std::sin(lower + kPi / kElevations) - std::sin(lower));
      for (int a = 0; a < kAzimuths; ++a) {
        if (directions_[index(a, e)].returns > 0) sum += belt;
      }
    }
    return sum;
  }

 private:
  static std::size_t index(int a, int e) { return std::size_t(e) * kAzimuths + std::size_t(a); }
  static int azimuth_of(const Vec3& p) {
    const double share = (std::atan2(p.y(), p.x()) + kPi) / (2.0 * kPi);
    return std::min(kAzimuths - 1, int(share * kAzimuths));
  }
  static int elevation_of(const Vec3& p, double range_m) {
    const double share = std::asin(std::clamp(p.z() / range_m, -1.0, 1.0)) / kPi + 0.5;
    return std::min(kElevations - 1, int(share * kElevations));
  }
  Direction& at(int a, int e) { return directions_[index(a, e)]; }
  bool sees(int a) const {
    for (int e = 0; e < kElevations; ++e) {
      if (directions_[index(a, e)].returns > 0) return true;
    }
    return false;
  }
  // A sector behind the sensor goes across the seam of the angles.
  static std::vector<Sector> joined_behind(std::vector<Sector> sectors) {
    if (sectors.size() < 2 || sectors.front().from_rad > -kPi + 1e-9 ||
        sectors.back().to_rad < kPi - 1e-9) {
      return sectors;
    }
    sectors.front().from_rad = sectors.back().from_rad - 2.0 * kPi;
    sectors.pop_back();
    return sectors;
  }

  std::vector<Direction> directions_;
};

double at_share(std::vector<double>& values, double share) {
  const auto nth = values.begin() + std::ptrdiff_t(share * double(values.size() - 1));
  std::ranges::nth_element(values, nth);
  return *nth;
}

void tell_times(const std::vector<RecordedCloud>& clouds, SensorReport& report) {
  std::vector<std::int64_t> stamps;
  double late = 0.0;
  for (const RecordedCloud& c : clouds) {
    stamps.push_back(c.cloud.stamp_ns);
    const double latency_s = 1e-9 * double(c.received_ns - time_span(c.cloud).last_ns);
    late += latency_s;
    report.latency_max_s = std::max(report.latency_max_s, latency_s);
  }
  report.latency_mean_s = late / double(clouds.size());
  std::ranges::sort(stamps);
  report.duration_s = 1e-9 * double(stamps.back() - stamps.front());
  for (std::size_t i = 1; i < stamps.size(); ++i) {
    report.longest_gap_s = std::max(report.longest_gap_s, 1e-9 * double(stamps[i] - stamps[i - 1]));
  }
  if (report.duration_s > 0.0) report.rate_hz = double(clouds.size() - 1) / report.duration_s;
}

// v T + v^2 / (2 a) = range - margin, with T all that passes before the vehicle brakes.
double speed_within(double range_m, const SensorReport& report, const SensorCheckOptions& o) {
  const double room_m = range_m - o.margin_m;
  if (!(room_m > 0.0)) return 0.0;
  const double period_s = report.rate_hz > 0.0 ? 1.0 / report.rate_hz : 0.0;
  const double a = o.a_max_m_s2;
  const double before_s = period_s + std::max(report.latency_max_s, 0.0) + o.reaction_s;
  return std::sqrt(a * a * before_s * before_s + 2.0 * a * room_m) - a * before_s;
}

}  // namespace

Result<SensorReport> check_sensor(const std::vector<RecordedCloud>& clouds,
                                  const SensorCheckOptions& options) {
  SensorReport report;
  Sphere sphere;
  std::vector<double> ranges, elevations;
  std::int64_t claimed = 0;
  for (const RecordedCloud& c : clouds) {
    claimed += c.claimed;
    for (const Vec3& p : c.cloud.points) {
      const double range_m = p.norm();
      if (!(range_m > 1e-6)) continue;  // a missing return, written as the sensor's own place
      ranges.push_back(range_m);
      elevations.push_back(std::asin(p.z() / range_m));
      sphere.add(p, range_m, report.clouds, options.body_reach_m);
    }
    ++report.clouds;
  }
  if (clouds.size() < 2 || ranges.empty()) {
    return fail(ErrorCode::invalid_input,
                "a sensor is judged by two clouds at least, with returns in them");
  }
  tell_times(clouds, report);
  const auto returns = std::int64_t(ranges.size());
  report.points = double(returns) / double(clouds.size());
  report.missing_share = claimed > 0 ? 1.0 - double(returns) / double(claimed) : 0.0;
  report.range_least_m = at_share(ranges, 0.01);
  report.range_median_m = at_share(ranges, 0.5);
  report.range_most_m = at_share(ranges, 0.99);
  report.elevation_lower_rad = at_share(elevations, 0.001);
  report.elevation_upper_rad = at_share(elevations, 0.999);
  report.blind = sphere.blind();
  sphere.tell_body(report.clouds, returns, report);
  report.dense_range_m = options.resolution_m / std::sqrt(sphere.solid_angle() / report.points);
  report.speed_m_s =
      speed_within(std::min(report.dense_range_m, report.range_most_m), report, options);
  return report;
}

}  // namespace goshawk::map_server
