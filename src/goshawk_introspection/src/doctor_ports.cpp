#include <fmt/format.h>
#include <unistd.h>

#include <charconv>
#include <filesystem>
#include <fstream>
#include <set>
#include <sstream>

#include "goshawk/introspection/doctor.hpp"

namespace goshawk::introspection {
namespace {

// Where DDS listens (RTPS 2.2, 9.6.1.1): participant p of domain d at 7400 + 250 d + 10 + 2 p for
// discovery, and at the next port for users' data.
constexpr int kBase = 7400;
constexpr int kPerDomain = 250;
constexpr int kFirst = 10;
constexpr int kLast = 10 + 2 * 60;  // runtime's Context looks for this many participants

constexpr int kBridgePort = 8765;  // of viewer_bridge, and of the page
constexpr int kPagePort = 8080;

std::string content_of(const char* path) {
  std::stringstream text;
  text << std::ifstream(path).rdbuf();
  return text.str();
}

// The program that holds a socket, if this user may see it.
std::string holder_of(long inode) {
  const std::string wanted = fmt::format("socket:[{}]", inode);
  std::error_code ignored;
  for (const auto& process : std::filesystem::directory_iterator("/proc", ignored)) {
    const std::string pid = process.path().filename().string();
    if (pid.find_first_not_of("0123456789") != std::string::npos) continue;
    std::error_code denied;
    for (const auto& file : std::filesystem::directory_iterator(process.path() / "fd", denied)) {
      if (std::filesystem::read_symlink(file.path(), denied).string() != wanted) continue;
      std::string name;
      std::getline(std::ifstream(process.path() / "comm"), name);
      return name + " (process " + pid + ")";
    }
  }
  return "a program of another user";
}

Finding check_viewer_port(const std::map<int, long>& listening, int port, const std::string& who,
                          const std::string& mend) {
  const std::string about = "TCP port " + std::to_string(port);
  const auto found = listening.find(port);
  if (found == listening.end()) return {about, Level::fine, "is free for " + who};
  return {about, Level::note, "is held by " + holder_of(found->second),
          who + " listens there by default", mend};
}

}  // namespace

std::map<int, long> ports_in_use(const std::string& table) {
  std::map<int, long> ports;
  std::istringstream lines(table);
  std::string line;
  std::getline(lines, line);  // headings
  while (std::getline(lines, line)) {
    // number: local remote state queues timer retransmissions user timeout inode ...
    std::istringstream words(line);
    std::string number, local, remote, state, skip;
    long inode = 0;
    words >> number >> local >> remote >> state >> skip >> skip >> skip >> skip >> skip >> inode;
    const auto colon = local.find(':');
    int port = 0;
    if (colon == std::string::npos) continue;
    const char* first = local.data() + colon + 1;
    const auto [end, error] = std::from_chars(first, local.data() + local.size(), port, 16);
    // 07: a UDP socket that is bound; 0A: a TCP socket that listens.
    if (error != std::errc{} || (state != "07" && state != "0A")) continue;
    ports[port] = inode;
  }
  return ports;
}

std::vector<int> domains_in_use(const std::string& udp_table) {
  std::set<int> domains;
  for (const auto& [port, inode] : ports_in_use(udp_table)) {
    const int offset = (port - kBase) % kPerDomain;
    if (port < kBase || offset < kFirst || offset > kLast || offset % 2 != 0) continue;
    domains.insert((port - kBase) / kPerDomain);
  }
  return {domains.begin(), domains.end()};
}

std::vector<int> stolen_ports(const std::map<int, long>& udp_ports, int domain) {
  std::vector<int> stolen;
  for (int offset = kFirst; offset <= kLast; offset += 2) {
    const int discovery = kBase + kPerDomain * domain + offset;
    const bool has_user_port = udp_ports.contains(discovery + 1);
    if (has_user_port && !udp_ports.contains(discovery)) stolen.push_back(discovery + 1);
  }
  return stolen;
}

Finding check_port_range(int domain, int first, int last) {
  const int low = kBase + kPerDomain * domain;
  const int high = low + kLast + 1;
  const std::string about = fmt::format("UDP ports of domain {}", domain);
  const std::string text = std::to_string(low) + " to " + std::to_string(high);
  if (high < first || low > last) return {about, Level::fine, text};
  return {about, Level::note,
          fmt::format("{} are within {} to {}, which the system gives to any program", text, first,
                      last),
          "a program that asks for any port may get one of them, and a participant then looks for "
          "another",
          fmt::format("choose a domain from 0 to {} (ROS_DOMAIN_ID)",
                      (first - kBase - kLast - 2) / kPerDomain)};
}

std::vector<Finding> check_ports(int domain, bool bridge_runs) {
  std::vector<Finding> findings;
  int first = 32768, last = 60999;  // Linux' default
  std::ifstream("/proc/sys/net/ipv4/ip_local_port_range") >> first >> last;
  findings.push_back(check_port_range(domain, first, last));
  const auto udp = ports_in_use(content_of("/proc/net/udp"));
  for (const int port : stolen_ports(udp, domain)) {
    findings.push_back({"UDP port " + std::to_string(port), Level::warning,
                        "of this domain is held by " + holder_of(udp.at(port)) +
                            ", which is not a participant of it",
                        "a participant that needs this port takes the next one, or cannot join",
                        "end that program, or choose another ROS_DOMAIN_ID"});
  }
  const auto listening = ports_in_use(content_of("/proc/net/tcp"));
  if (bridge_runs && listening.contains(kBridgePort)) {
    findings.push_back({"TCP port " + std::to_string(kBridgePort), Level::fine,
                        "is held by " + holder_of(listening.at(kBridgePort))});
  } else {
    findings.push_back(check_viewer_port(
        listening, kBridgePort, "viewer_bridge",
        "end that program, or goshawk run viewer_bridge --ros-args -p port:=8766 and goshawk view "
        "--bridge ws://127.0.0.1:8766"));
  }
  findings.push_back(check_viewer_port(listening, kPagePort, "the page of goshawk view",
                                       "end that program, or use goshawk view --port 0"));
  return findings;
}

}  // namespace goshawk::introspection
