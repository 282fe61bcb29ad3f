// goshawk_lab_link INTERFACE_A INTERFACE_B SEED: passes every frame from one interface to the other,
// both ways, through a link with faults. Its standard input says which ("loss 0.2", "delay 0.05",
// "jitter", "duplicate", "reorder", "cut SECONDS"), a line each; it ends with its input. With
// "count" it prints what it passed and lost so far.
//
// The kernel of a test machine may lack netem; this needs nothing but packet sockets.

#include <fmt/format.h>
#include <linux/if_packet.h>
#include <net/ethernet.h>
#include <net/if.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <arpa/inet.h>
#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <functional>
#include <queue>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "impairment.hpp"

namespace goshawk::lab {
namespace {

constexpr std::size_t kLongestFrame = 1 << 17;  // [byte] with the kernel's header of offloads
constexpr int kSocketBuffer = 8 << 20;          // [byte]
constexpr int kMostAtOnce = 256;                // frames of one direction before the others' turn

double now_s() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

[[noreturn]] void give_up(const std::string& what) {
  fmt::print(stderr, "goshawk_lab_link: {}: {}\n", what, std::strerror(errno));
  std::exit(1);
}

/// A socket that hears every frame that comes in at an interface, with its header of offloads: what
/// the sender has left to its hardware (checksums, segments) is passed on as it is.
int open_packet_socket(const std::string& interface) {
  const int s = socket(AF_PACKET, SOCK_RAW | SOCK_CLOEXEC | SOCK_NONBLOCK, htons(ETH_P_ALL));
  if (s < 0) give_up("no packet socket, which needs CAP_NET_RAW");
  const int on = 1;
  sockaddr_ll address{};
  address.sll_family = AF_PACKET;
  address.sll_protocol = htons(ETH_P_ALL);
  address.sll_ifindex = int(if_nametoindex(interface.c_str()));
  if (address.sll_ifindex == 0) give_up(interface);
  if (setsockopt(s, SOL_PACKET, PACKET_VNET_HDR, &on, sizeof on) != 0 ||
      setsockopt(s, SOL_PACKET, PACKET_IGNORE_OUTGOING, &on, sizeof on) != 0 ||
      bind(s, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0) {
    give_up(interface);
  }
  setsockopt(s, SOL_SOCKET, SO_RCVBUFFORCE, &kSocketBuffer, sizeof kSocketBuffer);
  setsockopt(s, SOL_SOCKET, SO_SNDBUFFORCE, &kSocketBuffer, sizeof kSocketBuffer);
  return s;
}

struct Frame {
  double leaves_s;
  std::uint64_t number;  // frames that leave at the same moment keep their order
  int out;
  std::vector<char> bytes;
  bool operator>(const Frame& other) const {
    return leaves_s != other.leaves_s ? leaves_s > other.leaves_s : number > other.number;
  }
};

class Link {
 public:
  Link(const std::string& a, const std::string& b, std::uint64_t seed)
      : sockets_{open_packet_socket(a), open_packet_socket(b)},
        ways_{Impairment(seed), Impairment(seed + 1)},
        buffer_(kLongestFrame) {}

  /// Until standard input ends.
  void run() {
    for (bool open = true; open;) {
      std::array<pollfd, 3> polled{pollfd{sockets_[0], POLLIN, 0}, pollfd{sockets_[1], POLLIN, 0},
                                   pollfd{STDIN_FILENO, POLLIN, 0}};
      wait(polled);
      for (int way : {0, 1}) {
        if (polled[std::size_t(way)].revents != 0) take_in(way);
      }
      if (polled[2].revents != 0) open = obey();
      send_due();
    }
  }

 private:
  void wait(std::span<pollfd> polled) {
    timespec left{};
    if (!waiting_.empty()) {
      const double left_s = std::max(0.0, waiting_.top().leaves_s - now_s());
      left.tv_sec = time_t(left_s);
      left.tv_nsec = long((left_s - double(left.tv_sec)) * 1e9);
    }
    if (ppoll(polled.data(), polled.size(), waiting_.empty() ? nullptr : &left, nullptr) < 0 &&
        errno != EINTR) {
      give_up("ppoll");
    }
  }

  void take_in(int way) {
    for (int k = 0; k < kMostAtOnce; ++k) {
      const auto size = recv(sockets_[std::size_t(way)], buffer_.data(), buffer_.size(), 0);
      if (size <= 0) return;
      const auto leaves_s = ways_[std::size_t(way)].departures(now_s());
      ++(leaves_s.empty() ? lost_ : passed_);
      for (const double moment_s : leaves_s) {
        waiting_.push({moment_s, number_++, sockets_[std::size_t(1 - way)],
                       {buffer_.begin(), buffer_.begin() + size}});
      }
    }
  }

  void send_due() {
    while (!waiting_.empty() && waiting_.top().leaves_s <= now_s()) {
      const Frame& frame = waiting_.top();
      // A queue that is full loses the frame, as a real link does.
      if (send(frame.out, frame.bytes.data(), frame.bytes.size(), 0) < 0) ++lost_;
      waiting_.pop();
    }
  }

  /// @return false at the end of the input
  bool obey() {
    std::array<char, 4096> text;
    const auto size = read(STDIN_FILENO, text.data(), text.size());
    if (size <= 0) return false;
    input_.append(text.data(), std::size_t(size));
    for (std::size_t end; (end = input_.find('\n')) != std::string::npos; input_.erase(0, end + 1)) {
      obey(input_.substr(0, end));
    }
    return true;
  }

  void obey(const std::string& line) {
    if (line == "count") {
      fmt::print("{} {}\n", passed_, lost_);
    } else if (!change(line)) {
      fmt::print("not understood: {}\n", line);
    } else {
      fmt::print("{}\n", line);
    }
    std::fflush(stdout);
  }

  bool change(const std::string& line) {
    const auto space = line.find(' ');
    if (space == std::string::npos) return false;
    const std::string word = line.substr(0, space);
    double value = 0.0;
    const char* end = line.data() + line.size();
    if (std::from_chars(line.data() + space + 1, end, value).ptr != end) return false;
    for (Impairment& way : ways_) {
      if (word == "cut") {
        way.cut_until(now_s() + value);
        continue;
      }
      LinkFaults faults = way.faults();
      if (!set(faults, word, value)) return false;
      way.set(faults);
    }
    return true;
  }

  static bool set(LinkFaults& faults, std::string_view word, double value) {
    if (word == "delay") return faults.delay_s = value, true;
    if (word == "jitter") return faults.jitter_s = value, true;
    if (word == "loss") return faults.loss = value, true;
    if (word == "duplicate") return faults.duplicate = value, true;
    if (word == "reorder") return faults.reorder = value, true;
    return false;
  }

  std::array<int, 2> sockets_;
  std::array<Impairment, 2> ways_;
  std::vector<char> buffer_;
  std::priority_queue<Frame, std::vector<Frame>, std::greater<>> waiting_;
  std::string input_;
  std::uint64_t number_ = 0;
  std::uint64_t passed_ = 0;
  std::uint64_t lost_ = 0;
};

}  // namespace
}  // namespace goshawk::lab

int main(int argc, char** argv) {
  std::uint64_t seed = 0;
  if (argc != 4 || std::from_chars(argv[3], argv[3] + std::strlen(argv[3]), seed).ec != std::errc{}) {
    fmt::print(stderr, "usage: goshawk_lab_link INTERFACE_A INTERFACE_B SEED\n");
    return 2;
  }
  goshawk::lab::Link link(argv[1], argv[2], seed);
  fmt::print("ready\n");
  std::fflush(stdout);
  link.run();
}
