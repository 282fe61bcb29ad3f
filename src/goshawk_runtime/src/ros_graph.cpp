#include "ros_graph.hpp"

#include <algorithm>

#include "any_type.hpp"
#include "message_type_impl.hpp"
#include "runtime_log.hpp"

namespace goshawk::runtime {

Gid gid_of(const eprosima::fastrtps::rtps::GUID_t& guid) {
  Gid gid{};
  const auto rest = std::ranges::copy(guid.guidPrefix.value, gid.begin()).out;
  std::ranges::copy(guid.entityId.value, rest);
  return gid;
}

void RosGraph::open(eprosima::fastdds::dds::DomainParticipant& participant,
                    eprosima::fastdds::dds::DataWriter* writer, RosGraphLayout layout,
                    const std::vector<std::string>& named) {
  const std::lock_guard lock(mutex_);
  participant_ = gid_of(participant.guid());
  writer_ = writer;
  // A peer of Iron may have been met already: only a choice overrules that.
  if (layout != RosGraphLayout::automatic) layout_ = layout;
  named_ = {named.begin(), named.end()};
  publish();
}

void RosGraph::close() {
  const std::lock_guard lock(mutex_);
  writer_ = nullptr;
}

void RosGraph::enter(const std::string& node) {
  const std::lock_guard lock(mutex_);
  if (++nodes_[node].count == 1) publish();
}

void RosGraph::leave(const std::string& node) {
  const std::lock_guard lock(mutex_);
  const auto at = nodes_.find(node);
  if (at == nodes_.end() || --at->second.count > 0) return;
  nodes_.erase(at);
  publish();
}

void RosGraph::add_reader(const std::string& node, const Guid& reader) {
  const std::lock_guard lock(mutex_);
  nodes_[node].readers.insert(gid_of(reader));
  publish();
}

void RosGraph::add_writer(const std::string& node, const Guid& writer) {
  const std::lock_guard lock(mutex_);
  nodes_[node].writers.insert(gid_of(writer));
  publish();
}

void RosGraph::remove(const Guid& endpoint) {
  const std::lock_guard lock(mutex_);
  const Gid gid = gid_of(endpoint);
  std::size_t removed = 0;
  for (auto& [name, node] : nodes_) removed += node.readers.erase(gid) + node.writers.erase(gid);
  if (removed > 0) publish();  // else its node ended before it
}

void RosGraph::found_iron() {
  const std::lock_guard lock(mutex_);
  if (layout_ != RosGraphLayout::automatic) return;
  layout_ = RosGraphLayout::iron;
  publish();
}

std::string RosGraph::shown_name(const std::string& node) const {
  if (named_.contains(node)) return node;
  std::string hidden = node;
  return hidden.insert(hidden.rfind('/') + 1, "_");
}

void RosGraph::publish() {
  if (writer_ == nullptr) return;
  RosEntities entities{participant_};
  for (const auto& [name, node] : nodes_) {
    entities.nodes.push_back({shown_name(name),
                              {node.readers.begin(), node.readers.end()},
                              {node.writers.begin(), node.writers.end()}});
  }
  auto bytes =
      encode(entities, layout_ == RosGraphLayout::iron ? GidLength::iron : GidLength::humble);
  Sample sample{type_.impl().support.get(), &bytes};
  if (writer_->write(&sample)) return;
  runtime_log().warn(
      "ros_discovery_info could not be published: ROS 2 does not see the newest nodes and topics "
      "of this process until the next change");
}

}  // namespace goshawk::runtime
