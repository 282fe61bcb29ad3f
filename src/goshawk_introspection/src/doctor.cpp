#include "goshawk/introspection/doctor.hpp"

#include <algorithm>
#include <fstream>
#include <map>
#include <memory>
#include <set>
#include <sstream>

#include "goshawk/conversions/geometry.hpp"
#include "goshawk/conversions/status.hpp"
#include "goshawk/introspection/session.hpp"
#include "goshawk_msgs.h"
#include "nav_msgs.h"

namespace goshawk::introspection {
namespace {

constexpr std::size_t kStamps = 20;  // messages whose age is measured
constexpr double kReports_s = 1.0;   // for latched reports to come

void add(std::vector<Finding>& all, std::vector<Finding> more) {
  std::ranges::move(more, std::back_inserter(all));
}

// Lists the nodes of the domain or, if there are none, other domains in use on this machine.
Finding company(const std::vector<runtime::ParticipantInfo>& participants, int domain) {
  if (!participants.empty()) {
    std::string nodes;
    for (const auto& p : participants) {
      for (const auto& node : p.nodes) nodes += (nodes.empty() ? "" : ", ") + node;
    }
    return {"domain " + std::to_string(domain), Level::fine,
            std::to_string(participants.size()) + " processes" +
                (nodes.empty() ? "" : ", with the nodes " + nodes)};
  }
  std::stringstream table;
  table << std::ifstream("/proc/net/udp").rdbuf();
  std::string others;
  for (const int d : domains_in_use(table.str())) {
    if (d != domain) others += (others.empty() ? "" : ", ") + std::to_string(d);
  }
  return {"domain " + std::to_string(domain), Level::note,
          others.empty() ? "no node is in this domain, nor in another one of this machine"
                         : "no node is in this domain, but there are nodes in " + others,
          "nodes of other domains cannot be reached",
          others.empty() ? "start something: goshawk launch flight"
                         : "set ROS_DOMAIN_ID to that domain"};
}

// The age of odometry on arrival shows whether the clocks of two machines differ.
std::vector<Finding> check_odometry(Session& session, double timeout_s) {
  const auto endpoints = session.context().endpoints();
  const auto has = [&](const auto& wanted) { return std::ranges::any_of(endpoints, wanted); };
  // Simulated time says nothing about a machine's clock.
  if (has([](const auto& e) { return e.writer && e.topic == "/clock"; })) return {};
  // The subscriptions outlive this function.
  const auto shared = std::make_shared<std::map<std::string, std::vector<double>>>();
  auto& ages_s = *shared;
  for (const auto& e : endpoints) {
    if (!e.writer || e.type != "nav_msgs/msg/Odometry" || ages_s.contains(e.topic)) continue;
    session.node().subscribe<nav_msgs::msg::Odometry>(
        e.topic, runtime::Qos::best_effort(),
        [shared, &ages = ages_s[e.topic]](const auto& m, const runtime::MessageInfo& info) {
          ages.push_back(1e-9 * double(info.received_ns - conversions::to_ns(m.header().stamp())));
        });
  }
  const auto enough = [&] {
    return std::ranges::all_of(ages_s, [](const auto& a) { return a.second.size() >= kStamps; });
  };
  session.wait_for(timeout_s, enough);
  std::vector<Finding> findings;
  for (const auto& [topic, ages] : ages_s) {
    if (!ages.empty()) findings.push_back(check_stamps(topic, ages));
  }
  return findings;
}

std::uint64_t refused_datagrams(const goshawk_msgs::msg::StageReport& m) {
  for (const auto& counter : m.counters()) {
    if (counter.name() == conversions::kRefusedDatagrams) return std::uint64_t(counter.value());
  }
  return 0;
}

// What the stages refused, as they have reported it.
std::vector<Finding> check_refusals(Session& session, double timeout_s) {
  namespace msg = goshawk_msgs::msg;
  std::set<std::string> topics;
  for (const auto& e : session.context().endpoints()) {
    if (e.writer && e.type == "goshawk_msgs/msg/StageReport") topics.insert(e.topic);
  }
  const auto shared = std::make_shared<std::map<std::string, msg::StageReport>>();  // by node
  for (const auto& topic : topics) {
    session.node().subscribe<msg::StageReport>(topic, runtime::Qos::latched(20),
                                               [shared](const msg::StageReport& m, const auto&) {
                                                 if (refused_datagrams(m) > 0)
                                                   (*shared)[m.node()] = m;
                                               });
  }
  if (!topics.empty()) session.wait_for(std::min(timeout_s, kReports_s), [] { return false; });
  std::vector<Finding> findings;
  for (const auto& [node, report] : *shared) {
    findings.push_back(check_refused(node, refused_datagrams(report), report.message()));
  }
  return findings;
}

bool has_node(const runtime::Context& context, const std::string& name) {
  return std::ranges::any_of(context.participants(), [&](const auto& p) {
    return std::ranges::any_of(p.nodes, [&](const auto& n) { return n.ends_with("/" + name); });
  });
}

}  // namespace

std::vector<Finding> examine(double timeout_s) {
  const ClockWatch clock;
  std::vector<Finding> findings = check_machine();
  add(findings, check_versions());
  add(findings, check_environment());
  auto session = Session::open();
  if (!session) {
    findings.push_back({"domain", Level::fault, session.error().message,
                        "no stage can join it either", "as the sentence says"});
    return findings;
  }
  (*session)->settle(timeout_s);
  auto& context = (*session)->context();
  add(findings, check_ports(context.domain(), has_node(context, "viewer_bridge")));
  const auto participants = context.participants();
  findings.push_back(company(participants, context.domain()));
  const auto options = runtime::ContextOptions::from_environment();
  const auto of_ros = std::ranges::count_if(participants, &runtime::ParticipantInfo::is_ros);
  if (options) findings.push_back(check_ros(ros_shell(), options->interfaces, int(of_ros)));
  add(findings, check_topics(participants, context.endpoints()));
  add(findings, check_odometry(**session, timeout_s));
  add(findings, check_refusals(**session, timeout_s));
  add(findings, clock.findings());
  return findings;
}

}  // namespace goshawk::introspection
