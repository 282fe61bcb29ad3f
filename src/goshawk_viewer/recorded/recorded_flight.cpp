#include "goshawk/viewer/recorded_flight.hpp"

#include "goshawk/conversions/geometry.hpp"
#include "goshawk/conversions/grid.hpp"
#include "goshawk/conversions/moving_boxes.hpp"
#include "goshawk/conversions/plan.hpp"
#include "goshawk/conversions/vehicle.hpp"
#include "goshawk/core/grid_update.hpp"
#include "goshawk/flight_report/movers.hpp"
#include "goshawk/map_server/voxel_map.hpp"
#include "goshawk/runtime/message_type.hpp"
#include "octomap_msgs.h"

namespace goshawk::viewer {
namespace {

namespace msg = goshawk_msgs::msg;
using flight_report::MoversMoment;
using flight_report::PredictionsMoment;

constexpr std::size_t kMostComplaints = 20;
constexpr double kLeastMoverStep_s = 0.1;  // between moments of what moves
constexpr std::size_t kMostMoverMoments = 20'000;
constexpr std::int64_t kMostVoxels = 300'000'000;  // that a page can draw

/// @return invalid_input if the bytes do not decode
template <typename Message>
Result<Message> decoded(const std::vector<unsigned char>& bytes) {
  Message message;
  if (!runtime::decode(bytes, message)) {
    return fail(ErrorCode::invalid_input, "the bytes do not decode as this message");
  }
  return message;
}

/// Whether "/uav1/odom" is an "odom".
bool is_called(const std::string& topic, const std::string& name) {
  return topic == name || topic.ends_with("/" + name);
}

double seconds(std::int64_t ns) {
  return double(ns) * 1e-9;
}

/// [s] since 1970
template <typename Message>
double stamp_s(const Message& m) {
  return seconds(conversions::to_ns(m.header().stamp()));
}

/// Appends a moment that holds and is new enough. @param check of the moment alone
template <typename Moment, typename Check>
Status keep(std::vector<Moment>& moments, Moment moment, const Check& check) {
  if (auto good = check(moment); !good) return good;
  const bool newer = moments.empty() || moment.t_s - moments.back().t_s >= kLeastMoverStep_s;
  if (newer && moments.size() < kMostMoverMoments) moments.push_back(std::move(moment));
  return success();
}

}  // namespace

std::map<std::uint16_t, RecordedFlight::Take> RecordedFlight::choose(
    const recording::Reader& reader) {
  struct Wanted {
    const char* name;
    const char* type;
    Take take;
  };
  static constexpr Wanted kWanted[] = {
      {"odom", "nav_msgs/msg/Odometry", &RecordedFlight::take_odometry},
      {"committed_trajectory", "goshawk_msgs/msg/CommittedTrajectory",
       &RecordedFlight::take_commitment},
      {"path", "goshawk_msgs/msg/Path", &RecordedFlight::take_path},
      {"octomap_binary", "octomap_msgs/msg/Octomap", &RecordedFlight::take_octomap},
      {"map/voxels", "goshawk_msgs/msg/VoxelGrid", &RecordedFlight::take_grown},
      {"map/voxels/updates", "goshawk_msgs/msg/VoxelGridUpdate", &RecordedFlight::take_update},
      {"navigator_state", "goshawk_msgs/msg/NavigatorState", &RecordedFlight::take_navigator},
      {"movers", "goshawk_msgs/msg/MovingBoxes", &RecordedFlight::take_movers},
      {"obstacles", "goshawk_msgs/msg/PredictedObstacles", &RecordedFlight::take_predictions}};
  std::map<std::uint16_t, Take> chosen;
  for (const auto& wanted : kWanted) {
    const recording::Channel* first = nullptr;
    for (const auto& [id, channel] : reader.channels()) {
      const auto* schema = reader.schema_of(channel);
      if (!schema || schema->name != wanted.type || !is_called(channel.topic, wanted.name))
        continue;
      if (!first || channel.topic < first->topic) first = &channel;
    }
    if (first) chosen[first->id] = wanted.take;
  }
  return chosen;
}

Result<RecordedFlight> RecordedFlight::read(recording::Reader& reader) {
  RecordedFlight flight;
  const auto chosen = choose(reader);
  recording::ReadOptions options;
  options.channels.emplace();
  for (const auto& [id, take] : chosen) options.channels->insert(id);
  Bytes bytes;
  const auto status = reader.read(options, [&](const recording::MessageView& m) {
    bytes.assign(m.data.begin(), m.data.end());
    const auto taken = (flight.*chosen.at(m.channel_id))(bytes);
    if (!taken && flight.complaints_.size() < kMostComplaints) {
      flight.complaints_.push_back(reader.channels().at(m.channel_id).topic + ": " +
                                   taken.error().message);
    }
    return true;
  });
  if (!status) return status.error();
  if (flight.is_empty()) {
    return fail(ErrorCode::invalid_input,
                "it holds nothing that this page can draw (odom, committed_trajectory, "
                "octomap_binary, map/voxels): goshawk view --foxglove shows any topic");
  }
  for (const auto& sentence : reader.complaints()) flight.complaints_.push_back(sentence);
  return flight;
}

Status RecordedFlight::take_odometry(const Bytes& bytes) {
  const auto m = decoded<nav_msgs::msg::Odometry>(bytes);
  if (!m) return m.error();
  const auto state = conversions::from_msg(*m);
  if (!state) return state.error();
  const std::int64_t stamp_ns = conversions::to_ns(m->header().stamp());
  if (!flown_.empty() && stamp_ns < flown_.back().stamp_ns) {
    return fail(ErrorCode::invalid_input, "time goes backwards: the repeated part is left out");
  }
  flown_.push_back({stamp_ns, {0.0, state->position_map, state->velocity_map, state->q_map_base}});
  return success();
}

Status RecordedFlight::take_commitment(const Bytes& bytes) {
  const auto m = decoded<msg::CommittedTrajectory>(bytes);
  if (!m) return m.error();
  auto committed = conversions::from_msg(*m);
  if (!committed) return committed.error();
  committed_.push_back(*std::move(committed));
  return success();
}

Status RecordedFlight::take_path(const Bytes& bytes) {
  const auto m = decoded<msg::Path>(bytes);
  if (!m) return m.error();
  auto waypoints = conversions::waypoints_of(*m);
  if (!waypoints) return waypoints.error();
  auto& leg = paths_[m->request().id()];
  leg.raw_path_map = conversions::from_msg(m->raw());
  leg.waypoints_map = *std::move(waypoints);
  return success();
}

Status RecordedFlight::take_octomap(const Bytes& bytes) {
  const auto m = decoded<octomap_msgs::msg::Octomap>(bytes);
  if (!m) return m.error();
  const std::string_view payload(reinterpret_cast<const char*>(m->data().data()), m->data().size());
  const auto tree = map_server::read_binary_payload(payload, m->resolution());
  if (!tree) return tree.error();
  auto voxels = map_server::voxelize(**tree, {.box = {}, .max_voxels = kMostVoxels});
  if (!voxels) return voxels.error();
  obstacles_.emplace();
  obstacles_->geometry = voxels->geometry;
  obstacles_->grown = std::move(voxels->occupied);
  return success();
}

Status RecordedFlight::take_grown(const Bytes& bytes) {
  const auto m = decoded<msg::VoxelGrid>(bytes);
  if (!m) return m.error();
  auto grid = conversions::from_msg(*m);
  if (!grid) return grid.error();
  maps_.take(stamp_s(*m), *std::move(grid));
  return success();
}

Status RecordedFlight::take_update(const Bytes& bytes) {
  const auto m = decoded<msg::VoxelGridUpdate>(bytes);
  if (!m) return m.error();
  const auto update = conversions::from_msg(*m);
  if (!update) return update.error();
  return maps_.take(stamp_s(*m), *update);
}

Status RecordedFlight::take_navigator(const Bytes& bytes) {
  const auto m = decoded<msg::NavigatorState>(bytes);
  if (!m) return m.error();
  if (m->state() == msg::NavigatorState_Constants::STATE_IDLE) return success();
  const Vec3 goal = conversions::from_msg(m->goal());
  if (!goal.allFinite()) return fail(ErrorCode::invalid_input, "a goal is not finite");
  if (goals_.empty() || goals_.back() != goal) goals_.push_back(goal);
  return success();
}

Status RecordedFlight::take_movers(const Bytes& bytes) {
  const auto m = decoded<msg::MovingBoxes>(bytes);
  if (!m) return m.error();
  auto boxes = conversions::from_msg(*m);
  if (!boxes) return boxes.error();
  return keep(movers_, MoversMoment{stamp_s(*m), *std::move(boxes)},
              [](const auto& one) { return flight_report::check_movers({one}, {}); });
}

Status RecordedFlight::take_predictions(const Bytes& bytes) {
  const auto m = decoded<msg::PredictedObstacles>(bytes);
  if (!m) return m.error();
  if (auto s = conversions::check_frame(m->header(), conversions::kMapFrame, "a prediction"); !s) {
    return s;
  }
  PredictionsMoment moment{stamp_s(*m), {}};
  for (const auto& obstacle : m->obstacles()) {
    const auto q = conversions::from_msg(obstacle.orientation());
    if (!q) return q.error();
    flight_report::PredictedBox box{
        .id = obstacle.id(),
        .q_map_box = *q,
        .half_extents_m = conversions::from_msg(obstacle.half_extents()),
        .track = {},
        .error_m = obstacle.error(),
        .error_rate_m_s = obstacle.error_rate(),
        .valid_until_s = obstacle.valid_until()};
    for (const auto& piece : obstacle.track()) {
      box.track.push_back({piece.duration(), conversions::from_msg(piece.control_points())});
    }
    moment.boxes.push_back(std::move(box));
  }
  return keep(predictions_, std::move(moment),
              [](const auto& one) { return flight_report::check_movers({}, {one}); });
}

void RecordedFlight::add_world(flight_report::Flight& flight, std::int64_t origin_ns) const {
  const double origin_s = seconds(origin_ns);
  flight.maps = maps_.moments();
  flight.movers = movers_;
  flight.predictions = predictions_;
  for (auto& moment : flight.maps) moment.t_s -= origin_s;
  for (auto& moment : flight.movers) moment.t_s -= origin_s;
  for (auto& moment : flight.predictions) moment.t_s -= origin_s;
}

flight_report::Flight RecordedFlight::flight(const std::string& title) const {
  flight_report::Flight flight;
  flight.title = title;
  flight.obstacles = obstacles_ ? &*obstacles_ : nullptr;
  flight.grown = maps_.newest() ? &*maps_.newest() : nullptr;
  flight.goals_map = goals_;
  std::int64_t origin_ns = 0;
  if (!committed_.empty()) origin_ns = committed_.front().start_time_ns();
  if (!flown_.empty()) origin_ns = flown_.front().stamp_ns;
  for (const auto& committed : committed_) {
    auto leg = flight_report::Leg::of(committed, origin_ns);
    if (const auto path = paths_.find(committed.id()); path != paths_.end()) {
      leg.raw_path_map = path->second.raw_path_map;
      leg.waypoints_map = path->second.waypoints_map;
    }
    flight.limits = committed.nominal().limits();
    flight.legs.push_back(std::move(leg));
  }
  for (const auto& [stamp_ns, sample] : flown_) {
    flight.flown.push_back(sample);
    flight.flown.back().t_s = seconds(stamp_ns - origin_ns);
  }
  add_world(flight, origin_ns);
  return flight;
}

}  // namespace goshawk::viewer
