#include <algorithm>
#include <sstream>

#include "context_impl.hpp"

namespace goshawk::runtime {
namespace {

template <typename T>
std::string text(const T& value) {
  std::ostringstream out;
  out << value;
  return out.str();
}

std::vector<std::string> nodes_in(const std::string& user_data) {
  std::vector<std::string> nodes;
  const std::string key = "nodes=";
  const auto at = user_data.find(key);
  if (at == std::string::npos) return nodes;
  std::istringstream list(user_data.substr(at + key.size()));
  for (std::string name; std::getline(list, name, ',');) {
    if (!name.empty()) nodes.push_back(name);
  }
  return nodes;
}

std::string version_in(const std::string& user_data) {
  const std::string key = "goshawk=";
  const auto at = user_data.find(key);
  if (at == std::string::npos) return "";
  const auto from = at + key.size();
  return user_data.substr(from, user_data.find(';', from) - from);
}

template <typename Info>
EndpointInfo endpoint(const Info& info, bool writer) {
  const std::string topic = text(info.topicName());
  EndpointInfo e;
  e.topic = topic.starts_with("rt/") ? topic.substr(2) : topic;
  e.type = ros_type_name(text(info.typeName()));
  e.participant = text(info.guid().guidPrefix);
  e.writer = writer;
  e.reliable = info.m_qos.m_reliability.kind == dds::RELIABLE_RELIABILITY_QOS;
  e.transient_local = info.m_qos.m_durability.kind >= dds::TRANSIENT_LOCAL_DURABILITY_QOS;
  return e;
}

}  // namespace

void DiscoveryListener::on_participant_discovery(dds::DomainParticipant*,
                                                 rtps::ParticipantDiscoveryInfo&& info) {
  const std::string key = text(info.info.m_guid.guidPrefix);
  const std::lock_guard lock(mutex_);
  if (info.status == rtps::ParticipantDiscoveryInfo::REMOVED_PARTICIPANT ||
      info.status == rtps::ParticipantDiscoveryInfo::DROPPED_PARTICIPANT) {
    participants_.erase(key);
    std::erase_if(endpoints_, [&](const auto& entry) { return entry.second.participant == key; });
    return;
  }
  const std::string user_data(info.info.m_userData.begin(), info.info.m_userData.end());
  participants_[key] = {key, info.info.m_participantName.to_string(), nodes_in(user_data),
                        version_in(user_data)};
}

void DiscoveryListener::on_publisher_discovery(dds::DomainParticipant* self,
                                               rtps::WriterDiscoveryInfo&& info) {
  if (info.info.guid().guidPrefix == self->guid().guidPrefix) return;
  const std::lock_guard lock(mutex_);
  const std::string key = text(info.info.guid());
  if (info.status == rtps::WriterDiscoveryInfo::REMOVED_WRITER) {
    endpoints_.erase(key);
  } else {
    endpoints_[key] = endpoint(info.info, true);
  }
}

void DiscoveryListener::on_subscriber_discovery(dds::DomainParticipant* self,
                                                rtps::ReaderDiscoveryInfo&& info) {
  if (info.info.guid().guidPrefix == self->guid().guidPrefix) return;
  const std::lock_guard lock(mutex_);
  const std::string key = text(info.info.guid());
  if (info.status == rtps::ReaderDiscoveryInfo::REMOVED_READER) {
    endpoints_.erase(key);
  } else {
    endpoints_[key] = endpoint(info.info, false);
  }
}

std::vector<ParticipantInfo> DiscoveryListener::participants() const {
  const std::lock_guard lock(mutex_);
  std::vector<ParticipantInfo> list;
  for (const auto& [key, info] : participants_) list.push_back(info);
  return list;
}

std::vector<EndpointInfo> DiscoveryListener::endpoints() const {
  const std::lock_guard lock(mutex_);
  std::vector<EndpointInfo> list;
  for (const auto& [key, info] : endpoints_) list.push_back(info);
  std::ranges::sort(list, {}, &EndpointInfo::topic);
  return list;
}

std::string ros_type_name(std::string_view wire_name) {
  std::string name(wire_name);
  if (name.ends_with('_')) name.pop_back();
  for (const auto& [from, to] : {std::pair{"::dds_::", "/"}, std::pair{"::", "/"}}) {
    for (auto at = name.find(from); at != std::string::npos; at = name.find(from)) {
      name.replace(at, std::string_view(from).size(), to);
    }
  }
  return name;
}

std::string wire_type_name(std::string_view ros_name) {
  std::string package(ros_name.substr(0, ros_name.find('/')));
  std::string type(ros_name.substr(ros_name.rfind('/') + 1));
  return package + "::msg::dds_::" + type + "_";
}

}  // namespace goshawk::runtime
