#include <spdlog/spdlog.h>

#include <fastrtps/types/TypesBase.h>
#include <algorithm>
#include <bit>
#include <cstdlib>

#include "any_type.hpp"
#include "apply_qos.hpp"
#include "node_impl.hpp"

namespace goshawk::runtime {

using eprosima::fastrtps::types::ReturnCode_t;

namespace {

// A stranger's flood must not push what is heard out of the reader before it is taken.
constexpr int kRoomBesideStrangers = 32;
constexpr int kRoomForMegabytes = 4;
constexpr auto kLookAtKept = std::chrono::milliseconds(50);

bool may_be_megabytes(std::string_view wire_name) {
  return wire_name.ends_with("::VoxelGrid_") || wire_name.ends_with("::Octomap_") ||
         wire_name.ends_with("::PointCloud2_");
}

}  // namespace

std::int64_t Node::Impl::waited_ns(const dds::SampleInfo& info) const {
  if (time.on) return 0;  // Fast DDS stamps with the system's clock
  return std::max<std::int64_t>(0, SystemClock().now_ns() - info.reception_timestamp.to_ns());
}

// @return the quality of service of its reader
Qos Node::Impl::guard(Subscription& s, Qos qos, const MessageType& type, Writers writers) {
  if (writers.group.empty()) return qos;
  auto& of_group = guards[writers.group];
  if (of_group == nullptr) of_group = std::make_shared<WriterGuard>(context, on_second_writer);
  s.guard = of_group;
  s.matches = std::make_unique<MatchListener>(of_group);
  s.part = std::move(writers.part);
  s.newest_only = qos.depth == 1;
  s.most_kept = qos.transient_local && !s.part ? std::size_t(qos.depth) : 0;
  qos.depth =
      std::max(qos.depth, may_be_megabytes(type.name()) ? kRoomForMegabytes : kRoomBesideStrangers);
  return qos;
}

std::unique_ptr<Subscription> Node::Impl::open(const Node& node, const std::string& name,
                                               const MessageType& type, Qos qos,
                                               Node::RawCallback callback, Writers writers) {
  auto* dds_topic = context.topic(name, type.impl().support);
  auto subscription = std::make_unique<Subscription>();
  const Qos held = guard(*subscription, qos, type, std::move(writers));
  dds::DataReaderQos reader_qos;
  bool own_port = false;
  if (context.subscriber->get_datareader_qos_from_profile(name, reader_qos) !=
      ReturnCode_t::RETCODE_OK) {
    reader_qos = dds::DATAREADER_QOS_DEFAULT;
    apply(held, reader_qos);
    // A process has one receiving thread for all other topics, where a setpoint would wait behind
    // the hundreds of datagrams of a map. In lock step everything comes in order through one
    // socket.
    own_port = may_be_megabytes(type.name()) && !time.in_lock_step() &&
               std::getenv("FASTRTPS_DEFAULT_PROFILES_FILE") == nullptr;
  }
  const auto create = [&] {
    return dds_topic == nullptr ? nullptr
                                : context.subscriber->create_datareader(
                                      dds_topic, reader_qos, subscription->matches.get(),
                                      dds::StatusMask::subscription_matched());
  };
  dds::DataReader* reader = nullptr;
  if (own_port) {
    auto& properties = reader_qos.properties().properties();
    properties.emplace_back("fastdds.unique_network_flows", "true");
    reader = create();
    has_own_ports |= reader != nullptr;
    if (reader == nullptr) properties.pop_back();  // all ports are taken
  }
  if (reader == nullptr) reader = create();
  if (reader == nullptr) {
    throw StartupFault(fail(ErrorCode::io_failed, node.name_ + " cannot read " + name + " as " +
                                                      type.name() + ": " +
                                                      context.why_no_endpoint()));
  }
  context.ros_graph.add_reader(node.full_name(), reader->guid());
  subscription->reader = reader;
  subscription->topic = name;
  subscription->type = type.impl().support;
  subscription->object = subscription->type.create_data();
  subscription->callback = std::move(callback);
  reader->get_statuscondition().set_enabled_statuses(dds::StatusMask::data_available());
  return subscription;
}

void Node::Impl::close(Subscription& s) {
  context.ros_graph.remove(s.reader->guid());
  context.subscriber->delete_datareader(s.reader);
  s.type.delete_data(s.object);
  if (s.newest != nullptr) s.type.delete_data(s.newest);
  for (auto& [object, info] : s.kept) s.type.delete_data(object);
}

void Node::subscribe_raw(std::string_view topic, const MessageType& type, Qos qos,
                         RawCallback callback, Writers writers) {
  auto subscription = impl_->open(*this, args_.resolve_topic(topic, name_), type, qos,
                                  std::move(callback), std::move(writers));
  impl_->wait_set.attach_condition(subscription->reader->get_statuscondition());
  impl_->subscriptions.push_back(std::move(subscription));
}

int Node::Impl::take_some(const Node& node, Subscription& s) {
  dds::SampleInfo info;
  int taken = 0;
  for (; taken < kMostAtOnce && !stopping; ++taken) {
    Sample sample{s.type.get(), s.object};
    if (s.reader->take_next_sample(&sample, &info) != ReturnCode_t::RETCODE_OK) break;
    if (!info.valid_data) continue;
    if (sample.decoded) {
      hear(node, s, info);
    } else if (std::has_single_bit(++s.undecoded)) {
      // Logs the 1st, 2nd, 4th, 8th ...: a hostile sender must not fill the disk.
      node.log_->warn("a message on {} could not be decoded and was dropped ({} so far): {}",
                      s.topic, s.undecoded,
                      sample.fault.empty() ? "does its sender use the same IDL?" : sample.fault);
    }
  }
  deliver_newest(node, s);
  return taken;
}

void Node::Impl::hear(const Node& node, Subscription& s, const dds::SampleInfo& info) {
  const MessageInfo told{node.now_ns(), waited_ns(info), info.source_timestamp.to_ns(),
                         participant_of(info.sample_identity.writer_guid().guidPrefix)};
  if (s.guard == nullptr) return call(node, s.topic, s.callback, s.object, told);
  const std::uint8_t part = s.part ? s.part(s.object) : 0;
  if ((!s.part || part != 0) && !s.guard->admits(told.writer, part, s.topic)) {
    return keep(s, told);
  }
  if (!s.kept.empty() && s.kept_of == told.writer) deliver_kept(node, s);
  if (!s.newest_only) return call(node, s.topic, s.callback, s.object, told);
  if (s.newest == nullptr) s.newest = s.type.create_data();
  std::swap(s.object, s.newest);
  s.newest_info = told;
  s.has_newest = true;
}

void Node::Impl::deliver_newest(const Node& node, Subscription& s) {
  if (!std::exchange(s.has_newest, false) || stopping) return;
  call(node, s.topic, s.callback, s.newest, s.newest_info);
}

void Node::Impl::keep(Subscription& s, const MessageInfo& info) {
  if (s.most_kept == 0) return;
  // Of one writer: of the first, unless that one is gone.
  if (s.kept_of != info.writer) {
    if (!s.kept.empty() && s.guard->is_matched(s.kept_of)) return;
    for (auto& [object, old] : std::exchange(s.kept, {})) s.type.delete_data(object);
    s.kept_of = info.writer;
  }
  s.kept.emplace_back(std::exchange(s.object, s.type.create_data()), info);
  if (s.kept.size() <= s.most_kept) return;
  s.type.delete_data(s.kept.front().first);
  s.kept.pop_front();
}

void Node::Impl::deliver_kept(const Node& node, Subscription& s) {
  for (auto& [object, info] : std::exchange(s.kept, {})) {
    if (!stopping) call(node, s.topic, s.callback, object, info);
    s.type.delete_data(object);
  }
}

void Node::Impl::look_at_kept(const Node& node) {
  const auto now = Steady::now();
  if (now - looked_at_kept < kLookAtKept) return;
  looked_at_kept = now;
  for (std::size_t i = 0; i < subscriptions.size() && !stopping; ++i) {
    Subscription& s = *subscriptions[i];
    if (!s.kept.empty() && s.guard->admits_now(s.kept_of)) deliver_kept(node, s);
  }
}

}  // namespace goshawk::runtime
