// By default a process neither sends multicast nor listens to anything but 127.0.0.1: an open
// network is not safe for DDS (README.md).

#include <gmock/gmock.h>

#include <fstream>
#include <sstream>

#include "domain.hpp"
#include "std_msgs.h"
#include "udp_sockets.hpp"

namespace goshawk::runtime {
namespace {

// Multicast packets that this machine sent so far.
long multicast_sent() {
  std::ifstream file("/proc/net/netstat");
  std::string names, values;
  while (std::getline(file, names) && std::getline(file, values)) {
    if (!names.starts_with("IpExt:")) continue;
    std::istringstream n(names), v(values);
    for (std::string name, value; n >> name && v >> value;) {
      if (name == "OutMcastPkts") return std::stol(value);
    }
  }
  return -1;
}

// Users of multicast groups: lines of /proc/net/igmp like "  010000EF     1 0:00000000  0".
int multicast_memberships() {
  std::ifstream file("/proc/net/igmp");
  int users = 0;
  for (std::string line; std::getline(file, line);) {
    std::istringstream words(line);
    std::string group;
    int count = 0;
    if (line.starts_with("\t\t") && words >> group >> count) users += count;
  }
  return users;
}

TEST(Loopback, ListensOnLoopbackAlone) {
  const auto context = runtime_test::join();
  Node node(*context, "node");
  node.subscribe<std_msgs::msg::String>("t", Qos::reliable_last(), [](const auto&, const auto&) {});
  // Of this process alone: others on the machine are not ours to judge.
  const auto sockets = runtime_test::udp_sockets();
  EXPECT_GE(sockets.size(), 2u);  // discovery and data at least
  const unsigned multicast_port = 7400u + 250u * unsigned(runtime_test::domain());
  for (const auto& socket : sockets) {
    EXPECT_EQ(socket.address, "0100007F") << socket.port;
    EXPECT_NE(socket.port, multicast_port);
  }
}

// Others on the machine may use multicast meanwhile, so one quiet trial of five is the proof.
TEST(Loopback, NeitherSendsNorJoinsMulticast) {
  if (multicast_sent() < 0) GTEST_SKIP() << "this kernel counts no multicast packets";
  for (int trial = 0; trial < 5; ++trial) {
    const long sent = multicast_sent();
    const int members = multicast_memberships();
    const auto context = runtime_test::join();
    const auto other = runtime_test::join();
    Node node(*context, "node");
    Node other_node(*other, "other");
    int got = 0;
    node.subscribe<std_msgs::msg::String>("t", Qos::latched(),
                                          [&](const auto&, const auto&) { ++got; });
    (void)other_node.advertise<std_msgs::msg::String>("t", Qos::latched()).publish({});
    runtime_test::spin_until(
        node, [] { return false; }, 0.5);
    if (multicast_sent() == sent && multicast_memberships() == members) return;
  }
  FAIL() << "multicast went out, or was joined, in five of five trials";
}

}  // namespace
}  // namespace goshawk::runtime
