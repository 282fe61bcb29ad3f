#include <fastrtps/types/TypesBase.h>
#include <fastdds/dds/subscriber/DataReader.hpp>
#include <fastdds/dds/subscriber/SampleInfo.hpp>

#include <algorithm>
#include <span>
#include <sstream>

#include "any_type.hpp"
#include "context_impl.hpp"
#include "message_type_impl.hpp"
#include "writer_guard.hpp"

namespace goshawk::runtime {
namespace {

constexpr std::size_t kMostSilent = 256;
constexpr std::size_t kLongestToldName = 80;

rtps::GuidPrefix_t prefix_of(const Participant& participant) {
  rtps::GuidPrefix_t prefix;
  std::ranges::transform(participant, std::begin(prefix.value),
                         [](std::byte b) { return static_cast<rtps::octet>(b); });
  return prefix;
}

// What strangers say of themselves goes into logs.
std::string printable(std::string text) {
  std::erase_if(text, [](unsigned char c) { return c < 0x20 || c >= 0x7f; });
  return text.substr(0, kLongestToldName);
}

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
  const bool took_leave = handshakes && tell_handshakes(info);
  const std::string key = text(info.info.m_guid.guidPrefix);
  const std::lock_guard lock(mutex_);
  if (info.status == rtps::ParticipantDiscoveryInfo::REMOVED_PARTICIPANT ||
      info.status == rtps::ParticipantDiscoveryInfo::DROPPED_PARTICIPANT) {
    participants_.erase(key);
    silent_since_.erase(key);
    ros_nodes_.erase(key);
    if (info.status == rtps::ParticipantDiscoveryInfo::DROPPED_PARTICIPANT && !took_leave) {
      if (silent_since_.size() >= kMostSilent) silent_since_.erase(silent_since_.begin());
      silent_since_[key] = std::chrono::steady_clock::now();
    }
    std::erase_if(endpoints_, [&](const auto& entry) { return entry.second.participant == key; });
    return;
  }
  silent_since_.erase(key);
  const std::string user_data(info.info.m_userData.begin(), info.info.m_userData.end());
  ParticipantInfo& found = participants_[key];
  found = {key, info.info.m_participantName.to_string(), nodes_in(user_data),
           version_in(user_data)};
  found.is_ros = found.version.empty() && user_data.find("enclave=") != std::string::npos;
}

template <typename Info>
bool DiscoveryListener::is_ros_discovery(const Info& info) const {
  if (text(info.topicName()) != kRosDiscoveryTopic) return false;
  const auto& user_data = info.m_qos.m_userData;
  const std::string_view kHash = "typehash=";  // Iron and later say it of every endpoint
  if (!std::ranges::search(user_data, kHash).empty()) ros_graph->found_iron();
  return true;
}

void DiscoveryListener::tell_ros_nodes(const rtps::GuidPrefix_t& participant,
                                       std::vector<std::string> names) {
  std::erase_if(names, [](const auto& name) { return name[name.rfind('/') + 1] == '_'; });
  const std::string key = text(participant);
  const std::lock_guard lock(mutex_);
  if (participants_.contains(key)) ros_nodes_[key] = std::move(names);
}

void RosNodesListener::on_data_available(dds::DataReader* reader) {
  const auto type = raw_message_type(kRosDiscoveryType);
  std::vector<unsigned char> bytes;
  dds::SampleInfo info;
  Sample sample{type.impl().support.get(), &bytes};
  while (reader->take_next_sample(&sample, &info) ==
         eprosima::fastrtps::types::ReturnCode_t::RETCODE_OK) {
    if (!info.valid_data) continue;
    auto told = decode_node_names(bytes);
    const auto& writer = info.sample_identity.writer_guid();
    // Each participant speaks for itself alone.
    if (!told ||
        !std::ranges::equal(writer.guidPrefix.value, std::span(told->participant).first<12>()))
      continue;
    told_.tell_ros_nodes(writer.guidPrefix, std::move(told->names));
  }
}

// Fast DDS sends nothing to a participant before this has returned.
// @return whether it has left, and not just fallen silent
bool DiscoveryListener::tell_handshakes(const rtps::ParticipantDiscoveryInfo& found) const {
  const Participant other = participant_of(found.info.m_guid.guidPrefix);
  if (found.status == rtps::ParticipantDiscoveryInfo::CHANGED_QOS_PARTICIPANT) return false;
  if (found.status != rtps::ParticipantDiscoveryInfo::DISCOVERED_PARTICIPANT) {
    return handshakes->left(other);
  }
  wire::Handshakes::Locators at;
  for (const auto& locator : found.info.metatraffic_locators.unicast) at.push_back(locator);
  handshakes->discovered(other, at);
  return false;
}

void DiscoveryListener::onParticipantAuthentication(dds::DomainParticipant*,
                                                    rtps::ParticipantAuthenticationInfo&& info) {
  const bool is_good = info.status == rtps::ParticipantAuthenticationInfo::AUTHORIZED_PARTICIPANT;
  if (handshakes && is_good) handshakes->authorized(participant_of(info.guid.guidPrefix));
}

void DiscoveryListener::on_publisher_discovery(dds::DomainParticipant* self,
                                               rtps::WriterDiscoveryInfo&& info) {
  if (info.info.guid().guidPrefix == self->guid().guidPrefix || is_ros_discovery(info.info)) return;
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
  if (info.info.guid().guidPrefix == self->guid().guidPrefix || is_ros_discovery(info.info)) return;
  const std::lock_guard lock(mutex_);
  const std::string key = text(info.info.guid());
  if (info.status == rtps::ReaderDiscoveryInfo::REMOVED_READER) {
    endpoints_.erase(key);
  } else {
    endpoints_[key] = endpoint(info.info, false);
  }
}

bool DiscoveryListener::fell_silent(const Participant& participant, double within_s) const {
  const std::lock_guard lock(mutex_);
  const auto at = silent_since_.find(text(prefix_of(participant)));
  if (at == silent_since_.end()) return false;
  const std::chrono::duration<double> since = std::chrono::steady_clock::now() - at->second;
  return since.count() < within_s;
}

bool DiscoveryListener::has_nodes(const Participant& participant) const {
  const std::lock_guard lock(mutex_);
  const auto at = participants_.find(text(prefix_of(participant)));
  return at != participants_.end() && !at->second.nodes.empty();
}

std::string DiscoveryListener::describe(const Participant& participant) const {
  const std::lock_guard lock(mutex_);
  const std::string guid = text(prefix_of(participant));
  const auto at = participants_.find(guid);
  if (at == participants_.end()) return "a participant that has left (GUID " + guid + ")";
  std::string nodes;
  for (const auto& node : at->second.nodes) nodes += (nodes.empty() ? "" : ", ") + node;
  std::string name = printable(at->second.name);
  constexpr std::string_view kOurs = "goshawk_";
  if (name.starts_with(kOurs)) name = "process " + name.substr(kOurs.size());
  if (name.empty()) name = "a participant";
  if (nodes.empty()) return name + " (GUID " + guid + ")";
  return printable(nodes) + " (" + name + ", GUID " + guid + ")";
}

std::vector<ParticipantInfo> DiscoveryListener::participants() const {
  const std::lock_guard lock(mutex_);
  std::vector<ParticipantInfo> list;
  for (const auto& [key, info] : participants_) {
    list.push_back(info);
    const auto told = ros_nodes_.find(key);
    if (info.is_ros && told != ros_nodes_.end()) list.back().nodes = told->second;
  }
  return list;
}

std::vector<EndpointInfo> DiscoveryListener::endpoints() const {
  const std::lock_guard lock(mutex_);
  std::vector<EndpointInfo> list;
  for (const auto& [key, info] : endpoints_) list.push_back(info);
  std::ranges::sort(list, {}, &EndpointInfo::topic);
  return list;
}

std::size_t DiscoveryListener::known() const {
  const std::lock_guard lock(mutex_);
  return participants_.size() + endpoints_.size();
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
