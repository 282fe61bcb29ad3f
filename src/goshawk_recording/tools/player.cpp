#include "player.hpp"

#include <algorithm>
#include <chrono>

#include "goshawk/introspection/interruptible.hpp"
#include "qos_profiles.hpp"
#include "restamp.hpp"

namespace goshawk::recording {
namespace {

using introspection::Interruptible;

constexpr double kSlice_s = 0.05;   // how often a wait looks for Ctrl-C
constexpr double kSettled_s = 0.7;  // no new reader for this long: all are found
constexpr double kClockPeriod_s = 0.01;
constexpr double kWord_s = 3.0;  // a longer wait is explained
// A recorder serves topic by topic: messages within this time may be recorded in another order.
constexpr std::uint64_t kDisorder_ns = 2'000'000'000;
constexpr std::size_t kFragments_bytes = 60'000;  // larger messages arrive in parts

std::int64_t steady_ns() {
  return std::chrono::steady_clock::now().time_since_epoch().count();
}

bool is_large(const std::string& type) {
  return type.ends_with("/VoxelGrid") || type.ends_with("/Octomap") ||
         type.ends_with("/PointCloud2");
}

}  // namespace

Player::Player(runtime::Node& node, Reader& reader, const std::set<std::uint16_t>& channels,
               ReplayOptions options, Say say)
    : node_(node),
      reader_(reader),
      options_(std::move(options)),
      say_(std::move(say)),
      channels_(channels) {
  for (const auto id : channels) {
    const Channel& channel = reader.channels().at(id);
    const std::string type = reader.schema_of(channel)->name;
    const auto profiles = channel.metadata.find(kQosKey);
    runtime::Qos qos =
        offered_by_player(profiles == channel.metadata.end() ? "" : profiles->second);
    // The depth of its writer is not recorded; of maps only the newest one counts.
    if (qos.transient_local && is_large(type)) qos.depth = 1;
    const auto known = introspection::find_type(type);
    tracks_[id] = {
        node.advertise_raw(options_.prefix + channel.topic,
                           runtime::raw_message_type(runtime::wire_type_name(type)), qos),
        known ? *known : nullptr, qos.transient_local, qos.reliable,
        turn_of(options_.prefix + channel.topic, type)};
  }
  if (!options_.plant.empty()) {
    options_.plant = options_.prefix + options_.plant;
    plant_turns_ = node.advertise_raw(options_.plant + kTurnEnd,
                                      runtime::raw_message_type(runtime::wire_type_name(kTurnType)),
                                      runtime::Qos::reliable_last());
  }
  if (!options_.lock_step.empty() || !options_.plant.empty()) turns_.emplace(node, say_);
  if (options_.clock) {
    clock_ =
        node.advertise_raw("/clock", runtime::raw_message_type("rosgraph_msgs::msg::dds_::Clock_"),
                           runtime::Qos::best_effort());
    node.every(kClockPeriod_s, [this] { publish_clock(); });
  }
}

int Player::matched() const {
  int sum = 0;
  for (const auto& [id, track] : tracks_) sum += track.publisher.matched();
  return sum;
}

void Player::wait_for_readers() {
  if (turns_) wait_for_turn_takers();
  settle(options_.wait_s);
}

void Player::wait_for_turn_takers() {
  if (!options_.plant.empty()) wait_for_turn_taker(plant_turns_, options_.plant);
  for (const auto& [id, track] : tracks_) {
    if (!track.turn_of.empty()) wait_for_turn_taker(track.publisher, track.turn_of);
  }
}

void Player::wait_for_turn_taker(const runtime::RawPublisher& turns, const std::string& node) {
  const auto begin = steady_ns();
  bool said = false;
  while (!Interruptible::interrupted() && turns.matched() == 0) {
    if (!said && double(steady_ns() - begin) * 1e-9 > kWord_s) {
      say_("waiting for " + node + " to run with lock_step: true");
      said = true;
    }
    node_.spin_some(kSlice_s);
  }
}

void Player::settle(double longest_s) {
  const auto begin = steady_ns();
  auto changed = begin;
  int known = -1;
  const auto since = [](std::int64_t ns) { return double(steady_ns() - ns) * 1e-9; };
  while (!Interruptible::interrupted() && since(begin) < longest_s && since(changed) < kSettled_s) {
    const int now = matched();
    if (now != known) changed = steady_ns();
    known = now;
    node_.spin_some(kSlice_s);
  }
}

Status Player::play() {
  return turns_ ? play_in_lock_step() : play_in_time();
}

Status Player::play_in_lock_step() {
  roll_.clear();
  Status played = success();
  const auto read = reader_.read({.channels = channels_}, [&](const MessageView& m) {
    held_.emplace(m.publish_time_ns,
                  Held{m.channel_id, m.log_time_ns, Bytes(m.data.begin(), m.data.end())});
    if (m.log_time_ns > kDisorder_ns) played = play_held(m.log_time_ns - kDisorder_ns);
    return played.ok() && !Interruptible::interrupted();
  });
  if (read && played) played = play_held(std::numeric_limits<std::uint64_t>::max());
  if (read && played && !options_.plant.empty() && !Interruptible::interrupted()) {
    played = turns_->give_plant(plant_turns_, nullptr, options_.plant);
  }
  held_.clear();
  return played ? read : played;
}

// Everything until then, in the order of publication.
Status Player::play_held(std::uint64_t until_ns) {
  while (!held_.empty() && held_.begin()->second.log_time_ns <= until_ns &&
         !Interruptible::interrupted()) {
    if (auto status = play_in_order(held_.begin()->second); !status) return status;
    held_.erase(held_.begin());
  }
  return success();
}

Status Player::play_in_order(Held& held) {
  Track& track = tracks_.at(held.channel);
  if (!options_.plant.empty() && reader_.channels().at(held.channel).topic == kClock) {
    if (auto s = turns_->give_plant(plant_turns_, &held.data, options_.plant); !s) return s;
    call_the_roll(options_.plant);
  }
  if (track.turn_of.empty()) {
    ++published_;
    if (auto status = track.publisher.publish_raw(&held.data); !status) return status;
    // Lost fragments are sent again later: they must arrive before the next turn.
    if (track.reliable && held.data.size() > kFragments_bytes) {
      (void)track.publisher.wait_acknowledged(options_.wait_s);
    }
    return success();
  }
  if (auto status = turns_->give(track.publisher, held.data, track.turn_of); !status) return status;
  call_the_roll(track.turn_of);
  return success();
}

// After their first turns the nodes find each other, as in the flight.
void Player::call_the_roll(const std::string& node) {
  const std::size_t all = options_.lock_step.size() + (options_.plant.empty() ? 0 : 1);
  if (roll_.insert(node).second && roll_.size() == all) settle(options_.wait_s);
}

Status Player::play_in_time() {
  from_ns_ = reader_.start_ns() + std::uint64_t(options_.start_offset_s * 1e9);
  if (auto status = publish_latched_before(from_ns_); !status) return status;
  begin_ns_ = steady_ns();
  playing_ = true;
  Status published = success();
  const auto read =
      reader_.read({.from_ns = from_ns_, .channels = channels_}, [&](const MessageView& m) {
        wait_until(begin_ns_ + std::int64_t(double(m.log_time_ns - from_ns_) / options_.rate));
        if (Interruptible::interrupted()) return false;
        published = publish(tracks_.at(m.channel_id), m.data, m.log_time_ns);
        return published.ok();
      });
  playing_ = false;
  return published ? read : published;
}

// A replay that starts in the middle first publishes latched topics as they were then.
Status Player::publish_latched_before(std::uint64_t from_ns) {
  if (from_ns <= reader_.start_ns()) return success();
  std::set<std::uint16_t> latched;
  for (const auto& [id, track] : tracks_) {
    if (track.transient_local) latched.insert(id);
  }
  if (latched.empty()) return success();
  Status published = success();
  const auto read =
      reader_.read({.to_ns = from_ns - 1, .channels = latched}, [&](const MessageView& m) {
        published = publish(tracks_.at(m.channel_id), m.data, m.log_time_ns);
        return published.ok() && !Interruptible::interrupted();
      });
  return published ? read : published;
}

Status Player::publish(Track& track, View data, std::uint64_t log_time_ns) {
  message_.assign(data.begin(), data.end());
  if (options_.restamp && track.type != nullptr) {
    const std::int64_t shift_ns = node_.now_ns() - std::int64_t(log_time_ns);
    if (auto status = shift_stamps(*track.type, message_, shift_ns); !status) return status;
  }
  ++published_;
  return track.publisher.publish_raw(&message_);
}

void Player::wait_until(std::int64_t until_ns) {
  for (;;) {
    const double left_s = double(until_ns - steady_ns()) * 1e-9;
    if (left_s <= 0.0 || Interruptible::interrupted()) return;
    node_.spin_some(std::min(left_s, kSlice_s));
  }
}

void Player::publish_clock() {
  if (!playing_) return;
  const auto passed = std::uint64_t(double(steady_ns() - begin_ns_) * options_.rate);
  const std::uint64_t now_ns = from_ns_ + passed;
  Bytes bytes = {0, 1, 0, 0};  // little-endian CDR of builtin_interfaces/Time
  const auto sec = std::uint32_t(now_ns / 1'000'000'000);
  const auto nanosec = std::uint32_t(now_ns % 1'000'000'000);
  for (const std::uint32_t value : {sec, nanosec}) {
    for (int byte = 0; byte < 4; ++byte) bytes.push_back((unsigned char)(value >> (8 * byte)));
  }
  (void)clock_.publish_raw(&bytes);  // best effort: the next one follows soon
}

void Player::finish() {
  for (const auto& [id, track] : tracks_) (void)track.publisher.wait_acknowledged(1.0);
}

}  // namespace goshawk::recording
