#include "map_examiner.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>

#include "goshawk/conversions/grid.hpp"
#include "goshawk/conversions/plan.hpp"
#include "goshawk/conversions/vehicle.hpp"
#include "goshawk/core/random.hpp"
#include "world.hpp"

namespace goshawk::conformance {
namespace {

namespace msg = goshawk_msgs::msg;
using runtime::MessageInfo;
using runtime::Qos;
using sensor_msgs::msg::PointCloud2;

constexpr std::uint32_t kFloat_byte = 4, kPoint_byte = 12;
constexpr std::uint8_t kFloat32 = 7;
constexpr double kWall_m = 0.6;  // half its edge

PointCloud2 cloud_of(const std::vector<Vec3>& points_map, std::int64_t now_ns) {
  PointCloud2 m;
  m.header(conversions::make_header(now_ns));
  for (std::uint32_t axis = 0; axis < 3; ++axis) {
    sensor_msgs::msg::PointField field;
    field.name(std::string(1, "xyz"[axis]));
    field.offset(axis * kFloat_byte);
    field.datatype(kFloat32);
    field.count(1);
    m.fields().push_back(field);
  }
  m.height(1);
  m.width(std::uint32_t(points_map.size()));
  m.point_step(kPoint_byte);
  m.row_step(m.width() * kPoint_byte);
  m.data().resize(m.row_step());
  for (std::size_t k = 0; k < points_map.size(); ++k) {
    for (int axis = 0; axis < 3; ++axis) {
      const auto value = float(points_map[k][axis]);
      std::memcpy(m.data().data() + k * kPoint_byte + std::size_t(axis) * kFloat_byte, &value,
                  sizeof value);
    }
  }
  return m;
}

bool same_bits(const VoxelGrid& a, const VoxelGrid& b) {
  return a.grown == b.grown && a.known == b.known;
}

}  // namespace

MapExaminer::MapExaminer(runtime::Context& context, const Options& options)
    : options_(options),
      context_(context),
      node_(context, "goshawk_conform", in_namespace(options.node_namespace)),
      listener_(node_, options.stage),
      clouds_(node_.advertise<Cloud>("cloud_in", Qos::reliable_last())),
      odometry_(node_.advertise<nav_msgs::msg::Odometry>("odom", Qos::best_effort())) {
  node_.subscribe<msg::VoxelGrid>("map/voxels", Qos::latched(),
                                  [this](const auto& m, const auto&) { take_whole(m); });
  node_.subscribe<msg::VoxelGridUpdate>("map/voxels/updates", Qos::reliable_last(50),
                                        [this](const auto& m, const auto&) { take_update(m); });
  node_.subscribe<octomap_msgs::msg::Octomap>("octomap_binary", Qos::latched(),
                                              [this](const auto& m, const auto&) { octomap_ = m; });
}

Result<Report> MapExaminer::examine(const std::vector<Cloud>& recorded) {
  if (!spin_until(options_.ready_timeout_s, [&] { return clouds_.matched() > 0; })) {
    return fail(ErrorCode::stage_silent, "no node reads cloud_in: is " + options_.stage +
                                             " running, in this domain and namespace?");
  }
  report_.stage = options_.stage;
  spin_until(options_.timeout_s, [&] { return listener_.ready(); });
  report_.items.push_back(
      {"reports that it is ready", listener_.ready(),
       listener_.ready() ? "" : "no stage_report of request 0 with code ok came"});
  examine_first_map();
  if (grid_) {
    examine_late_joiner();
    examine_octomap();
    vehicle_map_ = grid_->geometry.center(
        {grid_->geometry.size.x / 2, grid_->geometry.size.y / 2, grid_->geometry.size.z / 2});
    send_vehicle();
    examine_scan();
    examine_bad();
    examine_recorded(recorded);
    examine_garbage();
    report_.items.push_back(wholes_valid_.item());
    report_.items.push_back(chain_.item());
  }
  add_latency(report_, std::move(latencies_s_));
  report_.implementation = listener_.implementation();
  return report_;
}

bool MapExaminer::spin_until(double timeout_s, const std::function<bool()>& done) {
  const std::int64_t end_ns = node_.now_ns() + std::int64_t(timeout_s * 1e9);
  while (!done() && node_.now_ns() < end_ns) node_.spin_some(0.02);
  return done();
}

void MapExaminer::take_whole(const msg::VoxelGrid& m) {
  ++wholes_;
  auto grid = conversions::from_msg(m);
  wholes_valid_.check(grid && grid->version > 0, grid ? "it has version 0" : grid.error().message);
  if (!grid) return;
  whole_version_ = grid->version;
  if (grid_ && grid_->version > grid->version) return;  // an older one, late
  if (grid_ && grid_->version == grid->version) {
    chain_.check(same_bits(*grid_, *grid),
                 fmt::format("version {} differs from its updates", grid->version));
  }
  grid_ = *std::move(grid);
  changed_ns_ = node_.now_ns();
}

void MapExaminer::take_update(const msg::VoxelGridUpdate& m) {
  if (!grid_ || grid_->version >= m.to_version()) return;
  const auto update = conversions::from_msg(m);
  chain_.check(
      update && m.from_version() == grid_->version,
      update ? fmt::format("it applies to version {}, not to {}", m.from_version(), grid_->version)
             : update.error().message);
  if (!update || m.from_version() != grid_->version) return;
  const Status applied = apply(*grid_, *update);
  chain_.check(bool(applied), applied ? "" : applied.error().message);
  changed_ns_ = node_.now_ns();
}

void MapExaminer::examine_first_map() {
  const bool came = spin_until(10.0 * options_.timeout_s, [&] { return grid_.has_value(); });
  report_.items.push_back({"publishes a map", came,
                           came          ? to_text(grid_->geometry.size) + " voxels"
                           : wholes_ > 0 ? "none was valid"
                                         : "no message came on map/voxels"});
}

void MapExaminer::examine_late_joiner() {
  std::uint64_t version = 0;
  runtime::Node late(context_, "late", in_namespace(options_.node_namespace));
  late.subscribe<msg::VoxelGrid>("map/voxels", Qos::latched(),
                                 [&](const auto& m, const auto&) { version = m.version(); });
  const std::int64_t end_ns = late.now_ns() + std::int64_t(5e9 * options_.timeout_s);
  while (version == 0 && late.now_ns() < end_ns) late.spin_some(0.02);
  spin_until(0.1, [] { return false; });
  const bool same = version != 0 && version >= grid_->version;
  report_.items.push_back(
      {"gives late joiners the newest map", same, fmt::format("version {}", version)});
}

void MapExaminer::examine_octomap() {
  spin_until(options_.timeout_s, [&] { return octomap_.has_value(); });
  std::string fault;
  if (!octomap_) {
    fault = "no message came on octomap_binary";
  } else if (octomap_->header().frame_id() != "map") {
    fault = "its frame is '" + octomap_->header().frame_id() + "'";
  } else if (!octomap_->binary() || octomap_->id() != "OcTree") {
    fault = "it is not a binary OcTree";
  } else if (std::abs(octomap_->resolution() - grid_->geometry.resolution_m) > 1e-9) {
    fault = "its resolution is not the grid's";
  }
  report_.items.push_back({"publishes an OctoMap", fault.empty(), fault});
}

void MapExaminer::place_vehicle(std::int64_t stamp_ns) {
  nav_msgs::msg::Odometry m;
  RigidBodyState state;
  state.position_map = vehicle_map_;
  conversions::fill_msg(state, m);
  m.header(conversions::make_header(stamp_ns));
  (void)odometry_.publish(m);
}

void MapExaminer::send_vehicle() {
  // Best effort: only some of them arrive.
  for (int k = 0; k < 10; ++k) {
    place_vehicle(node_.now_ns());
    spin_until(0.03, [] { return false; });
  }
}

bool MapExaminer::see(const Cloud& cloud) {
  listener_.listen(0);
  const std::uint64_t before = grid_->version;
  const std::int64_t sent_ns = node_.now_ns();
  // Measured just now, where the vehicle is.
  place_vehicle(sent_ns);
  Cloud stamped = cloud;
  stamped.header().stamp(conversions::to_stamp(sent_ns));
  (void)clouds_.publish(stamped);
  const bool changed = spin_until(options_.timeout_s,
                                  [&] { return grid_->version > before || listener_.failed(); }) &&
                       grid_->version > before;
  if (changed) latencies_s_.push_back(double(changed_ns_ - sent_ns) * 1e-9);
  return changed;
}

std::vector<Vec3> MapExaminer::wall(double ahead_m) const {
  std::vector<Vec3> points;
  const double step_m = 0.5 * grid_->geometry.resolution_m;
  for (double y = -kWall_m; y <= kWall_m; y += step_m) {
    for (double z = -kWall_m; z <= kWall_m; z += step_m) {
      const Vec3 p = vehicle_map_ + Vec3(ahead_m, y, z);
      if (grid_->geometry.index_of(p)) points.push_back(p);
    }
  }
  return points;
}

void MapExaminer::examine_scan() {
  const auto& geometry = grid_->geometry;
  const double half_m = 0.5 * geometry.resolution_m * geometry.size.x;
  const double ahead_m = std::min(1.5, 0.6 * half_m);
  const auto points = wall(ahead_m);
  Tally taken("changes the map after a scan"), seen("measured points become obstacles"),
      grown("obstacles are grown by the map's inflation"),
      cleared("space along the rays becomes known");
  // Twice, for maps that count hits.
  for (int k = 0; k < 2; ++k) {
    taken.check(see(cloud_of(points, node_.now_ns())), listener_.failed()
                                                           ? listener_.reports().back().message()
                                                           : "no newer version came");
  }
  for (const Vec3& p : points) {
    const Index3 i = *geometry.index_of(p);
    seen.check(grid_->grown.test(i), "the voxel of " + to_text(p) + " m is free");
    const int reach = int(grid_->inflation_m / geometry.resolution_m);
    for (int axis = 0; axis < 3; ++axis) {
      for (int d = -reach; d <= reach; ++d) {
        const Index3 near{i.x + (axis == 0 ? d : 0), i.y + (axis == 1 ? d : 0),
                          i.z + (axis == 2 ? d : 0)};
        grown.check(grid_->grown.test(near),
                    fmt::format("a voxel {} from an obstacle is free", std::abs(d)));
      }
    }
    const Index3 half_way = *geometry.index_of(vehicle_map_ + 0.5 * (p - vehicle_map_));
    cleared.check(grid_->known.empty() || grid_->known.get(half_way),
                  "the voxel half-way to " + to_text(p) + " m is unknown");
  }
  for (const Tally* t : {&taken, &seen, &grown, &cleared}) report_.items.push_back(t->item());
}

void MapExaminer::examine_bad() {
  const VoxelGrid before = *grid_;
  const auto refuse = [&](const char* name, const std::set<std::string>& codes, auto&& change) {
    Cloud cloud = cloud_of(wall(0.7), node_.now_ns());
    change(cloud);
    see(cloud);
    report_.items.push_back(listener_.refusal(name, codes));
  };
  refuse("a cloud without x", {"invalid_input"}, [](Cloud& c) { c.fields()[0].name("u"); });
  refuse("a cloud that claims more points than it has", {"invalid_input"}, [](Cloud& c) {
    c.width(c.width() * 1000);
    c.row_step(c.row_step() * 1000);
  });
  refuse("a field outside its point", {"invalid_input"},
         [](Cloud& c) { c.fields()[2].offset(4'000'000'000U); });
  refuse("a big-endian cloud", {"invalid_input"}, [](Cloud& c) { c.is_bigendian(true); });
  refuse("a cloud in another frame", {"wrong_frame"},
         [](Cloud& c) { c.header().frame_id("nowhere"); });
  spin_until(0.3, [] { return false; });
  report_.items.push_back({"keeps its map after bad clouds", same_bits(before, *grid_), ""});
  see(cloud_of(std::vector<Vec3>(20, Vec3(kNan, kNan, kNan)), node_.now_ns()));
  report_.items.push_back(
      {"does not take missing returns for obstacles", before.grown == grid_->grown, ""});
}

void MapExaminer::examine_recorded(const std::vector<Cloud>& recorded) {
  if (recorded.empty()) return;
  Tally answered("answers every recorded cloud");
  for (std::size_t k = 0; k < recorded.size(); ++k) {
    const bool changed = see(recorded[k]);
    answered.check(changed || listener_.failed(),
                   fmt::format("cloud {} had neither a newer map nor a report", k));
  }
  report_.items.push_back(answered.item());
}

void MapExaminer::examine_garbage() {
  const auto raw = node_.advertise_raw(
      "cloud_in", runtime::raw_message_type(runtime::message_type<Cloud>().name()),
      Qos::reliable_last());
  spin_until(1.0, [&] { return raw.matched() > 0; });
  Random random(options_.seed);
  for (int k = 0; k < 10; ++k) {
    std::vector<unsigned char> bytes = {0, 1, 0, 0};
    for (int n = random.below(600); n > 0; --n) bytes.push_back((unsigned char)(random.below(256)));
    (void)raw.publish_raw(&bytes);
  }
  spin_until(0.3, [] { return false; });
  send_vehicle();
  const bool lives = see(cloud_of(wall(0.9), node_.now_ns()));
  report_.items.push_back({"survives garbage", lives, lives ? "" : "a good cloud changed nothing"});
  // Its updates are compared with the next whole map.
  spin_until(5.0 * options_.timeout_s, [&] { return whole_version_ >= grid_->version; });
}

}  // namespace goshawk::conformance
