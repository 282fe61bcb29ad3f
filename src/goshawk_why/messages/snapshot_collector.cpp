#include "goshawk/why_messages/snapshot_collector.hpp"

#include <algorithm>
#include <functional>

#include "goshawk/conversions/grid.hpp"
#include "goshawk/conversions/plan.hpp"
#include "goshawk/conversions/status.hpp"
#include "goshawk/conversions/vehicle.hpp"
#include "goshawk/core/grid_update.hpp"

namespace goshawk::why {
namespace {

namespace msg = goshawk_msgs::msg;
using runtime::Qos;

/// @param space "/uav1", "/", or nothing for a name that a node completes
std::string topic_in(const std::string& space, const std::string& name) {
  return space.empty() ? name : space == "/" ? "/" + name : space + "/" + name;
}

double seconds_between(std::int64_t from_ns, std::int64_t to_ns) {
  return double(to_ns - from_ns) * 1e-9;
}

template <typename Enum>
Enum at_most(std::uint8_t value, Enum last) {
  return Enum(std::min<std::uint8_t>(value, std::uint8_t(last)));
}

static_assert(std::uint8_t(Snapshot::Navigator::State::held) ==
              msg::NavigatorState_Constants::STATE_HELD);
static_assert(std::uint8_t(Snapshot::Tracker::Mode::land) ==
              msg::TrackingState_Constants::MODE_LAND);
static_assert(std::uint8_t(Snapshot::Status::Control::autopilot) ==
              msg::VehicleStatus_Constants::CONTROL_AUTOPILOT);

}  // namespace

template <typename Visitor>
void SnapshotCollector::for_each_topic(Visitor&& visit) {
  visit.template operator()<nav_msgs::msg::Odometry>("odom", Qos::best_effort());
  visit.template operator()<msg::VehicleStatus>("vehicle_status", Qos::best_effort());
  visit.template operator()<msg::NavigatorState>("navigator_state", Qos::latched(20));
  visit.template operator()<msg::NavigatorState>("navigator_alive", Qos::best_effort());
  visit.template operator()<msg::TrackingState>("tracking_state", Qos::best_effort());
  visit.template operator()<msg::MissionState>("mission_state", Qos::latched());
  visit.template operator()<msg::StageReport>("stage_report", Qos::latched(20));
  visit.template operator()<msg::CommittedTrajectory>("committed_trajectory", Qos::latched());
  visit.template operator()<msg::VoxelGrid>("map/voxels", Qos::latched());
  visit.template operator()<msg::VoxelGridUpdate>("map/voxels/updates", Qos::reliable_last(50));
}

void SnapshotCollector::listen(runtime::Node& node, const std::string& space) {
  for_each_topic([&]<typename Message>(const char* name, Qos qos) {
    node.subscribe<Message>(
        topic_in(space, name), qos,
        [this, &node](const Message& m, const runtime::MessageInfo&) { take(m, node.now_ns()); });
  });
}

Status SnapshotCollector::read(recording::Reader& reader, const std::string& space,
                               std::uint64_t until_ns) {
  std::map<std::uint16_t, std::function<void(const std::vector<unsigned char>&, std::int64_t)>> all;
  recording::ReadOptions options{.to_ns = until_ns};
  options.channels.emplace();
  for_each_topic([&]<typename Message>(const char* name, Qos) {
    for (const auto& [id, channel] : reader.channels()) {
      if (channel.topic != topic_in(space, name)) continue;
      options.channels->insert(id);
      all[id] = [this](const std::vector<unsigned char>& bytes, std::int64_t at_ns) {
        Message message;
        if (runtime::decode(bytes, message)) take(message, at_ns);
      };
    }
  });
  std::vector<unsigned char> bytes;
  return reader.read(options, [&](const recording::MessageView& m) {
    bytes.assign(m.data.begin(), m.data.end());
    all.at(m.channel_id)(bytes, std::int64_t(m.log_time_ns));
    return true;
  });
}

void SnapshotCollector::take(const nav_msgs::msg::Odometry& m, std::int64_t at_ns) {
  const auto state = conversions::from_msg(m);
  if (!state) return;
  vehicle_ = {{.position_map = state->position_map, .speed_m_s = state->velocity_map.norm()},
              at_ns};
}

void SnapshotCollector::take(const msg::VehicleStatus& m, std::int64_t) {
  status_ = Snapshot::Status{.armed = m.armed(),
                             .control = at_most(m.control(), Snapshot::Status::Control::autopilot),
                             .failsafe = m.failsafe()};
}

void SnapshotCollector::take(const msg::NavigatorState& m, std::int64_t at_ns) {
  navigator_ = {m, at_ns};
}

void SnapshotCollector::take(const msg::TrackingState& m, std::int64_t at_ns) {
  tracker_ = {{.mode = at_most(m.mode(), Snapshot::Tracker::Mode::land)}, at_ns};
}

void SnapshotCollector::take(const msg::MissionState& m, std::int64_t) {
  namespace constants = msg::MissionState_Constants;
  mission_ = Snapshot::Mission{
      .waits = m.state() == constants::STATE_PAUSED || m.state() == constants::STATE_FAILED,
      .message = m.message()};
}

void SnapshotCollector::take(const msg::StageReport& m, std::int64_t) {
  const Snapshot::Report report{.stage = conversions::stage_role_of(m.stage()),
                                .request_id = m.request_id(),
                                .outcome = {conversions::error_code_of(m.code()), m.message()}};
  reports_.insert_or_assign(m.node(), report);
}

void SnapshotCollector::take(const msg::CommittedTrajectory& m, std::int64_t) {
  if (auto committed = conversions::from_msg(m)) committed_ = *std::move(committed);
}

void SnapshotCollector::take(const msg::VoxelGrid& m, std::int64_t) {
  auto grid = conversions::from_msg(m);
  if (!grid) return;
  map_ = {std::make_shared<const VoxelGrid>(*std::move(grid)),
          conversions::to_ns(m.header().stamp())};
}

// One that does not follow is dropped: the whole map comes again soon after.
void SnapshotCollector::take(const msg::VoxelGridUpdate& m, std::int64_t) {
  if (map_.value == nullptr || map_.value->version != m.from_version()) return;
  const auto update = conversions::from_msg(m);
  VoxelGrid grid = *map_.value;  // shares its bits
  if (!update || !apply(grid, *update)) return;
  map_ = {std::make_shared<const VoxelGrid>(std::move(grid)),
          conversions::to_ns(m.header().stamp())};
}

Snapshot SnapshotCollector::snapshot(std::int64_t now_ns) const {
  Snapshot s;
  s.status = status_;
  s.mission = mission_;
  s.map = map_.value;
  s.map_age_s = seconds_between(map_.stamp_ns, now_ns);
  if (vehicle_) {
    s.vehicle = vehicle_->value;
    s.vehicle->age_s = seconds_between(vehicle_->at_ns, now_ns);
  }
  if (tracker_) {
    s.tracker = tracker_->value;
    s.tracker->age_s = seconds_between(tracker_->at_ns, now_ns);
  }
  if (navigator_) {
    const auto& m = navigator_->value;
    s.navigator = Snapshot::Navigator{
        .state = at_most(m.state(), Snapshot::Navigator::State::held),
        .request_id = m.request_id(),
        .goal_map = conversions::from_msg(m.goal()),
        .reason = {conversions::error_code_of(m.code()), m.message()},
        .since_s = seconds_between(conversions::to_ns(m.header().stamp()), now_ns),
        .age_s = seconds_between(navigator_->at_ns, now_ns)};
  }
  for (const auto& [node, report] : reports_) s.reports.push_back(report);
  if (committed_) {
    s.flown = Snapshot::Flown{*committed_, seconds_between(committed_->start_time_ns(), now_ns)};
  }
  return s;
}

}  // namespace goshawk::why
