#include "goshawk/runtime/context.hpp"

#include <arpa/inet.h>
#include <ifaddrs.h>
#include <unistd.h>

#include <fastdds/rtps/transport/UDPv4TransportDescriptor.h>
#include <fastdds/rtps/transport/shared_mem/SharedMemTransportDescriptor.h>
#include <fastrtps/utils/IPLocator.h>
#include <fmt/format.h>
#include <algorithm>
#include <charconv>
#include <cstdlib>
#include <fastdds/dds/domain/DomainParticipantFactory.hpp>
#include <set>

#include "any_type.hpp"
#include "apply_qos.hpp"
#include "context_impl.hpp"
#include "goshawk/runtime/version.hpp"
#include "message_type_impl.hpp"
#include "writer_guard.hpp"

namespace goshawk::runtime {
namespace {

// Unicast discovery knocks at the ports of this many participants of the domain: more processes
// than any launch file here starts, few enough that the knocking costs nothing.
constexpr unsigned kMaxParticipants = 60;
constexpr int kLastDomain = 232;             // the ports of more would be above 65535
constexpr int kMostRosParticipants = 1000;   // whose messages wait for the thread that reads them
constexpr unsigned kSocketBuffer = 4 << 20;  // [byte] asked for; the kernel may give less

std::vector<std::string> split(const std::string& list) {
  std::vector<std::string> parts;
  for (std::size_t at = 0; at <= list.size();) {
    const auto comma = std::min(list.find(',', at), list.size());
    if (comma > at) parts.push_back(list.substr(at, comma - at));
    at = comma + 1;
  }
  return parts;
}

// Fast DDS takes an address that this machine lacks without a word, and then hears nothing.
Status check_interfaces(const std::string& interfaces) {
  if (interfaces == "loopback" || interfaces == "all") return success();
  std::set<std::string> here;
  ifaddrs* list = nullptr;
  if (getifaddrs(&list) != 0) return fail(ErrorCode::io_failed, "cannot list the interfaces");
  for (const ifaddrs* i = list; i != nullptr; i = i->ifa_next) {
    if (i->ifa_addr == nullptr || i->ifa_addr->sa_family != AF_INET) continue;
    char text[INET_ADDRSTRLEN];
    const auto* address = reinterpret_cast<const sockaddr_in*>(i->ifa_addr);
    if (inet_ntop(AF_INET, &address->sin_addr, text, sizeof text) != nullptr) here.insert(text);
  }
  freeifaddrs(list);
  const auto wanted = split(interfaces);
  const auto strange =
      std::ranges::find_if(wanted, [&](const auto& address) { return !here.contains(address); });
  if (!wanted.empty() && strange == wanted.end()) return success();
  std::string known;
  for (const auto& address : here) known += (known.empty() ? "" : ", ") + address;
  return fail(ErrorCode::invalid_parameter,
              fmt::format("interfaces '{}' are not 'loopback', 'all' or IPv4 addresses of this "
                          "machine, which has {}",
                          interfaces, known));
}

void use_udp(dds::DomainParticipantQos& qos, const std::string& interfaces) {
  auto udp = std::make_shared<eprosima::fastdds::rtps::UDPv4TransportDescriptor>();
  udp->maxInitialPeersRange = kMaxParticipants;
  udp->sendBufferSize = kSocketBuffer;
  udp->receiveBufferSize = kSocketBuffer;
  qos.transport().use_builtin_transports = false;
  qos.transport().user_transports.push_back(udp);
  if (interfaces == "all") return;
  const bool loopback = interfaces == "loopback";
  // Always loopback too: Fast DDS reaches other processes of this host there, a discovery server
  // for one, whichever of the host's addresses they name.
  if (!loopback) udp->interfaceWhiteList = split(interfaces);
  udp->interfaceWhiteList.push_back("127.0.0.1");
  if (!loopback) return;
  rtps::Locator_t peer;
  peer.kind = LOCATOR_KIND_UDPv4;
  rtps::IPLocator::setIPv4(peer, "127.0.0.1");
  qos.wire_protocol().builtin.initialPeersList.push_back(peer);
  // No multicast: neither announced to, nor listened on.
  qos.wire_protocol().builtin.metatrafficUnicastLocatorList.push_back(peer);
}

// Fast DDS makes its built-in transports itself, where no filter can be put in: the same two.
void name_builtin_transports(dds::TransportConfigQos& transports) {
  const auto most =
      std::max(transports.send_socket_buffer_size, transports.listen_socket_buffer_size);
  auto udp = std::make_shared<eprosima::fastdds::rtps::UDPv4TransportDescriptor>();
  udp->sendBufferSize = transports.send_socket_buffer_size;
  udp->receiveBufferSize = transports.listen_socket_buffer_size;
  auto memory = std::make_shared<eprosima::fastdds::rtps::SharedMemTransportDescriptor>();
  memory->segment_size(2 * most);
  memory->max_message_size(udp->max_message_size());
  transports.user_transports.insert(transports.user_transports.begin(), {udp, memory});
  transports.use_builtin_transports = false;
}

void filter_transports(dds::TransportConfigQos& transports, const wire::FilterOptions& options) {
  if (transports.use_builtin_transports) name_builtin_transports(transports);
  for (auto& transport : transports.user_transports) {
    transport = wire::filtered(transport, options);
  }
}

dds::DomainParticipantQos profile_qos() {
  auto* factory = dds::DomainParticipantFactory::get_instance();
  factory->load_profiles();
  return factory->get_default_participant_qos();
}

Result<RosGraphLayout> ros_graph_layout(std::string_view text) {
  if (text == "auto") return RosGraphLayout::automatic;
  if (text == "humble") return RosGraphLayout::humble;
  if (text == "iron") return RosGraphLayout::iron;
  if (text == "off") return RosGraphLayout::off;
  return fail(ErrorCode::invalid_parameter,
              fmt::format("GOSHAWK_ROS_GRAPH is '{}': it must be auto, humble, iron (for Iron and "
                          "later) or off",
                          text));
}

bool has_property(const dds::DomainParticipantQos& qos, const char* name) {
  return rtps::PropertyPolicyHelper::find_property(qos.properties(), name) != nullptr;
}

dds::DomainParticipantQos participant_qos(dds::DomainParticipantQos qos,
                                          const ContextOptions& options,
                                          const wire::FilterOptions& filter) {
  if (std::getenv("FASTRTPS_DEFAULT_PROFILES_FILE") == nullptr) use_udp(qos, options.interfaces);
  filter_transports(qos.transport(), filter);
  auto& discovery = qos.wire_protocol().builtin.discovery_config;
  // A client hears only of what it writes and reads, but `goshawk node list` asks for all.
  if (!rtps::ros_discovery_server_env().empty() &&
      rtps::load_environment_server_info(discovery.m_DiscoveryServers)) {
    discovery.discoveryProtocol = rtps::DiscoveryProtocol_t::SUPER_CLIENT;
  }
  // A killed process is forgotten after 3 s instead of 20, a restarted one met at once.
  discovery.leaseDuration = {3, 0};
  discovery.leaseDuration_announcementperiod = {0, 500'000'000};
  discovery.initial_announcements.count = 5;
  discovery.initial_announcements.period = {0, 50'000'000};
  std::string user_data = "enclave=/;goshawk=" + version() + ";nodes=";
  for (const auto& name : options.node_names) user_data += name + ",";
  qos.user_data().data_vec().assign(user_data.begin(), user_data.end());
  qos.name("goshawk_" + std::to_string(getpid()));
  return qos;
}

}  // namespace

Result<ContextOptions> ContextOptions::from_environment() {
  ContextOptions options;
  if (const char* interfaces = std::getenv("GOSHAWK_INTERFACES")) {
    if (*interfaces == '\0') {
      return fail(ErrorCode::invalid_parameter,
                  "GOSHAWK_INTERFACES is set but empty: unset it for loopback, or set it to all or "
                  "to IPv4 addresses of this machine");
    }
    options.interfaces = interfaces;
  }
  if (const char* text = std::getenv("ROS_DOMAIN_ID"); text != nullptr && *text != '\0') {
    const std::string_view view(text);
    const auto [end, error] =
        std::from_chars(view.data(), view.data() + view.size(), options.domain);
    if (error != std::errc{} || end != view.data() + view.size() || options.domain < 0 ||
        options.domain > kLastDomain) {
      return fail(ErrorCode::invalid_parameter, "ROS_DOMAIN_ID is '" + std::string(text) +
                                                    "': it must be a number from 0 to 232");
    }
  }
  if (const char* text = std::getenv("GOSHAWK_ROS_GRAPH"); text != nullptr && *text != '\0') {
    const auto layout = ros_graph_layout(text);
    if (!layout) return layout.error();
    options.ros_graph = *layout;
  }
  return options;
}

Result<std::unique_ptr<Context>> Context::create(const ContextOptions& options) {
  if (options.domain < 0 || options.domain > kLastDomain) {
    return fail(ErrorCode::invalid_parameter,
                fmt::format("there is no domain {}: it must be from 0 to 232", options.domain));
  }
  if (auto status = check_interfaces(options.interfaces); !status) return status.error();
  auto impl = std::make_unique<Impl>();
  impl->domain = options.domain;
  impl->listener.ros_graph = &impl->ros_graph;
  const auto profile = profile_qos();
  impl->has_permissions = has_property(profile, "dds.sec.access.plugin");
  if (has_property(profile, "dds.sec.auth.plugin")) {
    impl->listener.handshakes = std::make_shared<wire::Handshakes>();
  }
  const wire::FilterOptions filter{impl->refusals, impl->senders, impl->listener.handshakes,
                                   options.tap};
  const auto qos = participant_qos(profile, options, filter);
  auto* factory = dds::DomainParticipantFactory::get_instance();
  impl->participant = factory->create_participant(dds::DomainId_t(options.domain), qos,
                                                  &impl->listener, dds::StatusMask::none());
  if (impl->participant == nullptr) {
    return fail(
        ErrorCode::io_failed,
        fmt::format("cannot join domain {} on interfaces '{}': are its UDP ports (7400 + 250 "
                    "x domain and up) taken, is the interface up, is the profile file right?",
                    options.domain, options.interfaces));
  }
  if (const auto& handshakes = impl->listener.handshakes) {
    handshakes->begin(participant_of(impl->participant->guid().guidPrefix));
  }
  impl->publisher = impl->participant->create_publisher(dds::PUBLISHER_QOS_DEFAULT);
  impl->subscriber = impl->participant->create_subscriber(dds::SUBSCRIBER_QOS_DEFAULT);
  if (auto status = impl->open_ros_graph(options); !status) return status.error();
  return std::unique_ptr<Context>(new Context(std::move(impl)));
}

Context::Context(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
Context::~Context() = default;
int Context::domain() const {
  return impl_->domain;
}
std::vector<ParticipantInfo> Context::participants() const {
  return impl_->listener.participants();
}
std::vector<EndpointInfo> Context::endpoints() const {
  return impl_->listener.endpoints();
}
Status Context::watch_ros_nodes() {
  if (impl_->has_permissions) return success();
  const auto type = raw_message_type(kRosDiscoveryType);
  auto* topic = impl_->wire_topic(kRosDiscoveryTopic, type.impl().support);
  dds::DataReaderQos qos = dds::DATAREADER_QOS_DEFAULT;
  apply(Qos::latched(kMostRosParticipants), qos);
  auto* reader = topic == nullptr
                     ? nullptr
                     : impl_->subscriber->create_datareader(topic, qos, &impl_->ros_nodes,
                                                            dds::StatusMask::data_available());
  if (reader != nullptr) return success();
  return fail(ErrorCode::io_failed,
              fmt::format("cannot read {}: {}", kRosDiscoveryTopic, impl_->why_no_endpoint()));
}
std::uint64_t Context::refused_datagrams() const {
  return impl_->refusals->count();
}
std::string Context::last_refusal() const {
  return impl_->refusals->last();
}

Context::Impl::~Impl() {
  if (participant == nullptr) return;
  ros_graph.close();
  participant->delete_contained_entities();
  dds::DomainParticipantFactory::get_instance()->delete_participant(participant);
}

std::string Context::Impl::why_no_endpoint() const {
  return has_permissions ? "the permissions of this process' certificate do not allow it (goshawk "
                           "secure init), or another type uses this topic here"
                         : "another type uses this topic in this process, or its profile is wrong";
}

Status Context::Impl::open_ros_graph(const ContextOptions& options) {
  // With permissions nobody would read it: ROS 2's nodes have no certificates of this authority.
  if (options.ros_graph == RosGraphLayout::off || has_permissions) return success();
  const auto type = raw_message_type(kRosDiscoveryType);
  auto* topic = wire_topic(kRosDiscoveryTopic, type.impl().support);
  dds::DataWriterQos qos = dds::DATAWRITER_QOS_DEFAULT;
  apply(Qos::latched(), qos);
  apply_writer_times(qos);
  auto* writer = topic == nullptr ? nullptr : publisher->create_datawriter(topic, qos);
  if (writer == nullptr) {
    return fail(ErrorCode::io_failed,
                fmt::format("cannot write {}: {}", kRosDiscoveryTopic, why_no_endpoint()));
  }
  ros_graph.open(*participant, writer, options.ros_graph, options.node_names);
  return success();
}

dds::Topic* Context::Impl::topic(const std::string& ros_name, const dds::TypeSupport& type) {
  return wire_topic(wire_topic_name(ros_name), type);
}

dds::Topic* Context::Impl::wire_topic(const std::string& name, const dds::TypeSupport& type) {
  const std::lock_guard lock(topics_mutex_);
  if (auto* found = participant->lookup_topicdescription(name)) {
    if (found->get_type_name() != type.get_type_name()) return nullptr;
    return static_cast<dds::Topic*>(found);
  }
  dds::TypeSupport any = participant->find_type(type.get_type_name());
  if (any.empty()) {
    any.reset(new AnyType(type.get_type_name(), type->m_typeSize));
    any.register_type(participant);
  }
  return participant->create_topic(name, type.get_type_name(), dds::TOPIC_QOS_DEFAULT);
}

}  // namespace goshawk::runtime
