#include "dds/echo.hpp"

#include <atomic>
#include <stdexcept>
#include <thread>

namespace goshawk::bench {
namespace {

constexpr std::uint64_t kHowMany = std::uint64_t{1} << 63;  // a ping that asks for the count
constexpr double kEchoWithin_s = 20.0;
constexpr double kTimeout_s = 2.0;  // then a message is lost
constexpr int kWarm = 5;

double seconds_since(std::int64_t begin_ns) {
  return double(steady_ns() - begin_ns) * 1e-9;
}

Quality flood_quality(const LinkOptions& options) {
  return options.reliable ? Quality::reliable_all : Quality::best_effort;
}

}  // namespace

void echo(const LinkOptions& options, Member* member, const std::function<bool()>& stopping) {
  std::unique_ptr<Member> own;
  if (member == nullptr) {
    own = std::make_unique<Member>(options);
    member = own.get();
  }
  std::atomic<std::uint64_t> flooded = 0;
  std::atomic<std::int64_t> last_ns = 0;
  Sender pongs(*member, "pong");
  Receiver flood(
      *member, "flood",
      [&](const Stamp&) {
        ++flooded;
        last_ns = steady_ns();
      },
      flood_quality(options));
  Receiver pings(*member, "ping", [&](const Stamp& stamp) {
    const bool asks = (stamp.number & kHowMany) != 0;
    pongs.send(asks ? Stamp{kHowMany | flooded, last_ns} : stamp);
  });
  std::atomic<bool> done = false;
  std::thread taker([&] {
    while (!done) flood.wait(0.05);
  });
  while (!stopping()) {
    pings.wait(0.05);
    if (options.listener) std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  done = true;
  taker.join();
}

Asker::Asker(const LinkOptions& options, Member& member)
    : options_(options),
      pings_(member, "ping"),
      flood_(member, "flood", flood_quality(options)),
      pongs_(member, "pong", [this](const Stamp& stamp) { answer_ = stamp; }) {
  const std::int64_t begin_ns = steady_ns();
  while (pings_.matched() == 0 || flood_.matched() == 0 || pongs_.matched() == 0) {
    if (seconds_since(begin_ns) > kEchoWithin_s) throw std::runtime_error("no echo was found");
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  while (!ask({++number_, 0}, 0.1)) {
    if (seconds_since(begin_ns) > kEchoWithin_s)
      throw std::runtime_error("the echo does not answer");
  }
}

bool Asker::ask(Stamp stamp, double timeout_s) {
  const std::int64_t begin_ns = steady_ns();
  if (!pings_.send(stamp)) return false;
  const auto answered = [&] {
    return stamp.number == kHowMany ? (answer_.number & kHowMany) != 0
                                    : answer_.number == stamp.number;
  };
  while (!answered() && seconds_since(begin_ns) < timeout_s) pongs_.wait(timeout_s);
  return answered();
}

Trips Asker::round_trips(int count, double most_s, double pause_s) {
  Trips trips;
  for (int i = 0; i < kWarm; ++i) ask({++number_, 0}, kTimeout_s);
  const std::int64_t begin_ns = steady_ns();
  while (int(trips.us.size()) + trips.lost < count && seconds_since(begin_ns) < most_s) {
    const std::int64_t sent_ns = steady_ns();
    if (ask({++number_, sent_ns}, kTimeout_s)) {
      trips.us.push_back(double(steady_ns() - sent_ns) * 1e-3);
    } else {
      ++trips.lost;
    }
    if (pause_s > 0.0) std::this_thread::sleep_for(std::chrono::duration<double>(pause_s));
  }
  return trips;
}

Stamp Asker::counted() {
  answer_ = {};
  ask({kHowMany, 0}, kTimeout_s);
  return {answer_.number & ~kHowMany, answer_.sent_ns};
}

Flood Asker::flood(double time_s) {
  Flood flood;
  const std::int64_t begin_ns = steady_ns();
  while (seconds_since(begin_ns) < time_s) {
    if (flood_.send({std::uint64_t(flood.sent) + 1, steady_ns()})) ++flood.sent;
  }
  // Until nothing more comes.
  Stamp last;
  for (Stamp now = counted(); now.number != last.number; now = counted()) {
    last = now;
    if (int(now.number) >= flood.sent) break;
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
  }
  flood.received = int(last.number);
  flood.elapsed_s = double(last.sent_ns - begin_ns) * 1e-9;
  return flood;
}

}  // namespace goshawk::bench
