#pragma once

#include <fmt/format.h>

#include <filesystem>
#include <fstream>
#include <set>
#include <sstream>
#include <string>
#include <vector>

namespace goshawk::runtime_test {

struct UdpSocket {
  std::string address;  // hexadecimal, "0100007F" is 127.0.0.1
  unsigned port = 0;
};

/// The open UDP sockets of a process of this user.
inline std::vector<UdpSocket> udp_sockets(const std::string& pid = "self") {
  std::set<std::string> own;
  for (const auto& entry : std::filesystem::directory_iterator(fmt::format("/proc/{}/fd", pid))) {
    std::error_code ignored;
    const std::string target = std::filesystem::read_symlink(entry.path(), ignored).string();
    if (target.starts_with("socket:[")) own.insert(target.substr(8, target.size() - 9));
  }
  std::vector<UdpSocket> sockets;
  for (const char* table : {"/proc/net/udp", "/proc/net/udp6"}) {
    std::ifstream file(table);
    std::string line;
    std::getline(file, line);  // headings
    while (std::getline(file, line)) {
      std::istringstream words(line);
      std::string word, local;
      words >> word >> local;
      for (int i = 0; i < 8; ++i) words >> word;  // the tenth is the inode
      if (!own.contains(word)) continue;
      const auto colon = local.find(':');
      sockets.push_back(
          {local.substr(0, colon), unsigned(std::stoul(local.substr(colon + 1), nullptr, 16))});
    }
  }
  return sockets;
}

}  // namespace goshawk::runtime_test
