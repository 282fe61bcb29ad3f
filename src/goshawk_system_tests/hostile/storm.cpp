// goshawk_datagram_storm: mutated datagrams to every process of a domain on this machine.
//
// It joins the domain, captures real traffic, and sends mutations of it from a socket of its own:
// as a participant that has joined, and as each of the others. Exit status 0: all were sent.

#include <arpa/inet.h>
#include <fmt/format.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <charconv>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <set>
#include <sstream>
#include <string>
#include <thread>

#include "observer.hpp"

namespace {

using goshawk::hostile::Bytes;
using goshawk::hostile::Mutator;
using goshawk::hostile::Observer;
using goshawk::hostile::replace_name;
using Steady = std::chrono::steady_clock;

constexpr std::size_t kPrefixAt = 8, kPrefix = 12;  // [byte] of the sender's name in a datagram
constexpr int kFirstPort = 7400, kPortsOfADomain = 250;

struct Options {
  long count = 1000;
  std::uint64_t seed = 1;
  double rate = 1000.0;  // [1/s]
  double listen_s = 5.0;
};

/// UDP ports of 127.0.0.1 that belong to the domain.
std::set<unsigned> ports_of(int domain) {
  const unsigned first = unsigned(kFirstPort + kPortsOfADomain * domain);
  std::set<unsigned> ports;
  std::ifstream table("/proc/net/udp");
  std::string line;
  std::getline(table, line);  // headings
  while (std::getline(table, line)) {
    std::istringstream words(line);
    std::string slot, local;
    words >> slot >> local;
    const auto port = unsigned(std::stoul(local.substr(local.find(':') + 1), nullptr, 16));
    if (port >= first && port < first + unsigned(kPortsOfADomain)) ports.insert(port);
  }
  return ports;
}

class Socket {
 public:
  Socket() : socket_(socket(AF_INET, SOCK_DGRAM, 0)) {}
  ~Socket() { close(socket_); }
  Socket(const Socket&) = delete;
  Socket& operator=(const Socket&) = delete;
  void send(const Bytes& datagram, unsigned port) const {
    sockaddr_in to{};
    to.sin_family = AF_INET;
    to.sin_port = htons(std::uint16_t(port));
    to.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    (void)sendto(socket_, datagram.data(), datagram.size(), 0,
                 reinterpret_cast<const sockaddr*>(&to), sizeof to);
  }

 private:
  int socket_;
};

/// Sends what the observer sent, under another name: so the others think that one more has joined.
class Joined {
 public:
  explicit Joined(const Observer::Captured& captured) {
    if (captured.sent.empty()) return;
    const auto own = std::span(captured.sent.front()).subspan(kPrefixAt, kPrefix);
    name_.assign(own.begin(), own.end());
    for (std::size_t k = 4; k < kPrefix; ++k) name_[k] ^= std::byte{0x5a};
    for (Bytes d : captured.sent) {
      replace_name(d, own, name_);
      datagrams_.push_back(std::move(d));
    }
  }
  const std::vector<Bytes>& datagrams() const { return datagrams_; }
  Bytes as_own(Bytes other) const {
    const Bytes from(other.begin() + kPrefixAt, other.begin() + kPrefixAt + kPrefix);
    replace_name(other, from, name_);
    return other;
  }

 private:
  Bytes name_;
  std::vector<Bytes> datagrams_;
};

struct Sent {
  long as_joined = 0, as_others = 0;
};

Sent storm(const Options& options, const Observer::Captured& captured, const Joined& joined,
           const std::vector<unsigned>& ports) {
  // What others say of themselves, in the name of the one that has joined: no samples, since this
  // is about datagrams, and a member may publish.
  std::vector<Bytes> about_others;
  std::ranges::remove_copy_if(captured.received, std::back_inserter(about_others),
                              goshawk::hostile::carries_sample);
  goshawk::Random random(options.seed);
  Mutator mutate(random.next());
  const Socket socket;
  Sent sent;
  const auto begin = Steady::now();
  for (long k = 0; k < options.count; ++k) {
    const unsigned port = ports[std::size_t(random.below(int(ports.size())))];
    // Good news keeps it joined.
    if (k % 500 == 0) {
      for (const auto& d : joined.datagrams()) socket.send(d, port);
    }
    const int role = random.below(3);
    if (role == 0) {
      socket.send(mutate(joined.datagrams()), port);
    } else if (role == 1 && !about_others.empty()) {
      const Bytes changed = mutate(about_others);
      const bool has_name = changed.size() >= kPrefixAt + kPrefix;
      socket.send(has_name ? joined.as_own(changed) : changed, port);
    } else {
      socket.send(mutate(captured.received), port);
    }
    (role == 2 ? sent.as_others : sent.as_joined)++;
    std::this_thread::sleep_until(begin + std::chrono::duration<double>(double(k) / options.rate));
  }
  return sent;
}

bool read(const std::string& word, const std::string& value, Options& out) {
  const auto number = [&value](auto& to) {
    const auto [end, error] = std::from_chars(value.data(), value.data() + value.size(), to);
    return error == std::errc{} && end == value.data() + value.size() && to > 0;
  };
  if (word == "--count") return number(out.count);
  if (word == "--seed") return number(out.seed);
  if (word == "--rate") return number(out.rate);
  if (word == "--listen") return number(out.listen_s);
  return false;
}

int run(const Options& options) {
  const char* text = std::getenv("ROS_DOMAIN_ID");
  const int domain = text == nullptr ? 0 : std::atoi(text);
  const auto before = ports_of(domain);
  Observer observer;
  observer.watch(options.listen_s);
  const auto captured = observer.captured();
  const Joined joined(captured);
  if (captured.received.empty() || before.empty() || joined.datagrams().empty()) {
    fmt::print(stderr, "goshawk_datagram_storm: nobody is in domain {}\n", domain);
    return 1;
  }
  const auto begin = Steady::now();
  const Sent sent = storm(options, captured, joined, {before.begin(), before.end()});
  const double taken_s = std::chrono::duration<double>(Steady::now() - begin).count();
  fmt::print(
      "{{\"captured\": {}, \"ports\": {}, \"seed\": {}, \"as_joined\": {}, \"as_others\": {}, "
      "\"seconds\": {:.1f}}}\n",
      captured.received.size() + captured.sent.size(), before.size(), options.seed, sent.as_joined,
      sent.as_others, taken_s);
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  Options options;
  bool good = argc % 2 == 1;
  for (int k = 1; k + 1 < argc; k += 2) good = good && read(argv[k], argv[k + 1], options);
  if (!good) {
    fmt::print(
        stderr,
        "usage: goshawk_datagram_storm [--count N] [--seed N] [--rate PER_S] [--listen S]\n");
    return 2;
  }
  try {
    return run(options);
  } catch (const std::exception& e) {
    fmt::print(stderr, "goshawk_datagram_storm: {}\n", e.what());
    return 1;
  }
}
