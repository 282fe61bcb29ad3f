#include "map/processes.hpp"

#include <fmt/format.h>

#include <chrono>
#include <cstring>
#include <filesystem>
#include <optional>

#include "common/child.hpp"
#include "goshawk/conversions/geometry.hpp"
#include "goshawk/runtime/node.hpp"
#include "goshawk/runtime/private_domain.hpp"
#include "goshawk/stage/map_subscription.hpp"
#include "nav_msgs.h"
#include "sensor_msgs.h"

namespace goshawk::bench {
namespace {

using namespace goshawk::runtime;
using Steady = std::chrono::steady_clock;

constexpr double kMeet_s = 30.0;

double seconds_since(Steady::time_point begin) {
  return std::chrono::duration<double>(Steady::now() - begin).count();
}

std::vector<std::string> command_of(const ProcessesOptions& o) {
  const auto folder = std::filesystem::path(this_program()).parent_path();
  std::vector<std::string> words{(folder / "../../bin/goshawk_container").string(), "map_server",
                                 "--ros-args", "--log-level", "error"};
  const auto set = [&](const std::string& name, const std::string& value) {
    words.insert(words.end(), {"-p", name + ":=" + value});
  };
  set("use_box", "true");
  set("unknown", "blocked");
  set("radius_m", fmt::format("{:.6f}", o.inflation_m));
  set("margin_m", "0.0");
  set("resolution_m", fmt::format("{:.6f}", o.resolution_m));
  set("max_range_m", fmt::format("{:.6f}", o.range_m));
  for (int axis = 0; axis < 3; ++axis) {
    set(fmt::format("box_{}_min_m", "xyz"[axis]), fmt::format("{:.6f}", o.lower_map[axis]));
    set(fmt::format("box_{}_max_m", "xyz"[axis]), fmt::format("{:.6f}", o.upper_map[axis]));
  }
  return words;
}

sensor_msgs::msg::PointCloud2 cloud_of(const Shot& shot, std::int64_t stamp_ns) {
  sensor_msgs::msg::PointCloud2 m;
  m.header(conversions::make_header(stamp_ns));
  for (std::uint32_t axis = 0; axis < 3; ++axis) {
    sensor_msgs::msg::PointField field;
    field.name(std::string(1, "xyz"[axis]));
    field.offset(4 * axis);
    field.datatype(7);  // float32
    field.count(1);
    m.fields().push_back(field);
  }
  m.height(1);
  m.width(std::uint32_t(shot.points.size()));
  m.point_step(12);
  m.row_step(12 * m.width());
  m.is_dense(true);
  m.data().resize(m.row_step());
  std::uint8_t* to = m.data().data();
  for (const Vec3& p : shot.points) {
    const Eigen::Vector3f point = p.cast<float>();
    std::memcpy(to, point.data(), 12);
    to += 12;
  }
  return m;
}

/// The sensor and the planner; the map server is another process.
class Visit {
 public:
  explicit Visit(Context& context)
      : node_(context, "bench_map"),
        odometry_(node_.advertise<nav_msgs::msg::Odometry>("odom", Qos::best_effort(50))),
        clouds_(node_.advertise<sensor_msgs::msg::PointCloud2>("cloud_in", Qos::best_effort(2))),
        map_(
            node_, [this](const auto&) { ++maps_; }, [this](const Error& e) { fault_ = e; }) {}

  /// @return whether the map server was found and its map came
  bool meet() {
    const auto begin = Steady::now();
    while (seconds_since(begin) < kMeet_s) {
      node_.spin_some(0.02);
      if (maps_ > 0 && odometry_.matched() > 0 && clouds_.matched() > 0) return true;
    }
    return false;
  }

  void send_odometry(const Vec3& position_map, std::int64_t stamp_ns) {
    nav_msgs::msg::Odometry m;
    m.header(conversions::make_header(stamp_ns));
    m.child_frame_id("base_link");
    m.pose().pose().position(conversions::to_point(position_map));
    m.pose().pose().orientation().w(1.0);
    (void)odometry_.publish(m);
  }

  /// @return [ms] until the map has the scan; nothing if it does not come
  std::optional<double> send(const Shot& shot, double timeout_s) {
    const std::int64_t stamp_ns = node_.now_ns();
    const auto cloud = cloud_of(shot, stamp_ns);
    send_odometry(shot.from, stamp_ns);
    const std::uint64_t before = map_.grid()->version;
    const auto begin = Steady::now();
    if (!clouds_.publish(cloud)) return {};
    while (seconds_since(begin) < timeout_s) {
      node_.spin_some(0.001);
      if (map_.grid()->version > before) return 1e3 * seconds_since(begin);
    }
    return {};
  }

  void rest(double time_s) {
    const auto begin = Steady::now();
    while (seconds_since(begin) < time_s) node_.spin_some(time_s - seconds_since(begin));
  }

  const std::optional<Error>& fault() const { return fault_; }

 private:
  Node node_;
  Publisher<nav_msgs::msg::Odometry> odometry_;
  Publisher<sensor_msgs::msg::PointCloud2> clouds_;
  int maps_ = 0;
  std::optional<Error> fault_;
  stage::MapSubscription map_;
};

}  // namespace

Result<ProcessesSamples> measure_processes(std::span<const Shot> shots, const ProcessesOptions& o) {
  const auto domain = hold_private_domain();
  if (!domain) return domain.error();
  const Child server(command_of(o), *domain);
  ContextOptions where;
  where.domain = *domain;
  const auto context = Context::create(where);
  if (!context) return context.error();
  Visit visit(**context);
  if (!visit.meet()) {
    return fail(ErrorCode::stage_silent,
                fmt::format("no map came from {} within {:g} s", command_of(o).front(), kMeet_s));
  }
  ProcessesSamples samples;
  for (const Shot& shot : shots) {
    const auto begin = Steady::now();
    if (const auto took_ms = visit.send(shot, o.timeout_s)) {
      samples.total_ms.push_back(*took_ms);
    } else {
      ++samples.lost;
    }
    visit.rest(1.0 / o.rate_hz - seconds_since(begin));
  }
  if (visit.fault()) return *visit.fault();
  return samples;
}

}  // namespace goshawk::bench
