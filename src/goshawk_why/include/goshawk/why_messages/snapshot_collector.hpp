#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>

#include "goshawk/recording/reader.hpp"
#include "goshawk/runtime/node.hpp"
#include "goshawk/why/snapshot.hpp"
#include "goshawk_msgs.h"
#include "nav_msgs.h"

namespace goshawk::why {

/// Makes snapshots of a flight from what its topics say, live or recorded. Times are [ns] of the
/// wall clock, when a message was heard.
class SnapshotCollector {
 public:
  /// From now on, in the node's thread.
  /// @param space of the vehicle: "/uav1", or "/"; empty: the node's own, with its remappings
  void listen(runtime::Node& node, const std::string& space);
  /// All that was recorded of the vehicle until then. @param until_ns on the recording's clock
  /// @return io_failed
  Status read(recording::Reader& reader, const std::string& space, std::uint64_t until_ns);

  /// Whether navigator, vehicle, tracker and map were heard.
  bool is_complete() const { return navigator_ && vehicle_ && tracker_ && map_.value; }
  Snapshot snapshot(std::int64_t now_ns) const;

 private:
  template <typename Value>
  struct Heard {
    Value value;
    std::int64_t at_ns;
  };
  template <typename Visitor>
  static void for_each_topic(Visitor&& visit);

  void take(const nav_msgs::msg::Odometry& m, std::int64_t at_ns);
  void take(const goshawk_msgs::msg::VehicleStatus& m, std::int64_t at_ns);
  void take(const goshawk_msgs::msg::NavigatorState& m, std::int64_t at_ns);
  void take(const goshawk_msgs::msg::TrackingState& m, std::int64_t at_ns);
  void take(const goshawk_msgs::msg::MissionState& m, std::int64_t at_ns);
  void take(const goshawk_msgs::msg::StageReport& m, std::int64_t at_ns);
  void take(const goshawk_msgs::msg::CommittedTrajectory& m, std::int64_t at_ns);
  void take(const goshawk_msgs::msg::VoxelGrid& m, std::int64_t at_ns);
  void take(const goshawk_msgs::msg::VoxelGridUpdate& m, std::int64_t at_ns);

  struct Map {
    std::shared_ptr<const VoxelGrid> value;
    std::int64_t stamp_ns = 0;
  };

  std::optional<Heard<Snapshot::Vehicle>> vehicle_ = {};
  std::optional<Snapshot::Status> status_ = {};
  std::optional<Heard<goshawk_msgs::msg::NavigatorState>> navigator_ = {};
  std::optional<Heard<Snapshot::Tracker>> tracker_ = {};
  std::optional<Snapshot::Mission> mission_ = {};
  std::map<std::string, Snapshot::Report> reports_ = {};  // the newest, by node
  std::optional<CommittedTrajectory> committed_ = {};
  Map map_;
};

}  // namespace goshawk::why
