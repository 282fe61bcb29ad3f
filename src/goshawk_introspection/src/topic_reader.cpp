#include "goshawk/introspection/topic_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <functional>
#include <set>
#include <vector>

namespace goshawk::introspection {
namespace {

using Steady = std::chrono::steady_clock;

struct Found {
  std::string type;
  runtime::Qos qos;
};

// A reader may ask for no more than every writer offers; if nobody writes yet, for least.
Found choose(const std::vector<runtime::EndpointInfo>& endpoints, const TopicListener& listener) {
  std::vector<runtime::EndpointInfo> writers;
  std::ranges::copy_if(endpoints, std::back_inserter(writers), &runtime::EndpointInfo::writer);
  const auto& relevant = writers.empty() ? endpoints : writers;
  std::set<std::string> types;
  for (const auto& e : relevant) types.insert(e.type);
  Found found{relevant.front().type, runtime::Qos::best_effort(1000)};
  if (types.size() > 1) {
    listener.note(fmt::format("{} has {} types; this reads {}", relevant.front().topic,
                              types.size(), found.type));
  }
  found.qos.reliable =
      !writers.empty() && std::ranges::all_of(writers, &runtime::EndpointInfo::reliable);
  found.qos.transient_local =
      !writers.empty() && std::ranges::all_of(writers, &runtime::EndpointInfo::transient_local);
  if (found.qos.reliable) found.qos.depth = 100;
  return found;
}

/// Messages of one topic as they come, until enough have come.
class Follower {
 public:
  Follower(Session& session, const std::string& topic, const ReadOptions& options,
           const TopicListener& listener)
      : session_(session), topic_(topic), options_(options), listener_(listener) {}

  Status follow(const Found& found) {
    if (options_.newest && found.qos.transient_local) return hand_over_newest(found);
    subscribe(found, [this](const Bytes& bytes, const runtime::MessageInfo& info) {
      take({bytes, info.received_ns});
    });
    if (auto status = wait_for_first(); !status) return status;
    last_ = Steady::now();
    before_ = received_;
    session_.node().every(1.0, [this] { tick(); });
    return wait_for_rest();
  }

 private:
  using Bytes = std::vector<unsigned char>;

  void subscribe(const Found& found,
                 std::function<void(const Bytes&, const runtime::MessageInfo&)> take) {
    const auto type = runtime::raw_message_type(runtime::wire_type_name(found.type));
    session_.node().subscribe_raw(
        topic_, type, found.qos,
        [take = std::move(take)](const void* data, const runtime::MessageInfo& info) {
          take(*static_cast<const Bytes*>(data), info);
        });
  }

  // What writers keep comes at once: when nothing has come for a moment, all of it is there.
  Status hand_over_newest(const Found& found) {
    constexpr std::chrono::milliseconds kMoment{200};
    constexpr double kLongest_s = 1.0;  // the topic may be written all the time
    Bytes newest;
    runtime::MessageInfo newest_info;
    subscribe(found, [&](const Bytes& bytes, const runtime::MessageInfo& info) {
      ++received_;
      last_ = Steady::now();
      if (received_ > 1 && info.sent_ns < newest_info.sent_ns) return;
      newest = bytes;
      newest_info = info;
    });
    if (auto status = wait_for_first(); !status) return status;
    if (received_ == 0) return success();
    session_.wait_for(kLongest_s, [&] { return Steady::now() - last_ > kMoment; });
    (void)listener_.message({newest, newest_info.received_ns});
    return success();
  }

  void take(const RawMessage& message) {
    if (done_) return;
    ++received_;
    done_ = !listener_.message(message) || received_ == options_.count;
  }

  Status wait_for_first() {
    const bool came = session_.wait_for(options_.timeout_s, [this] { return received_ > 0; });
    if (came || Interruptible::interrupted()) return success();
    const auto sentence =
        fmt::format("no message came on {} within {:g} s", topic_, options_.timeout_s);
    if (!options_.patient) {
      return fail(ErrorCode::stage_silent, sentence + "; --timeout waits longer");
    }
    listener_.note(sentence + ": still waiting, Ctrl-C ends");
    return success();
  }

  void tick() {
    if (received_ > before_) last_ = Steady::now();
    before_ = received_;
    if (!done_) listener_.tick();
  }

  Status wait_for_rest() {
    while (!done_ && !Interruptible::interrupted()) {
      session_.wait_for(1.0, [this] { return done_; });
      const std::chrono::duration<double> silent = Steady::now() - last_;
      if (options_.count > 0 && !done_ && received_ == before_ &&
          silent.count() > std::max(2.0, options_.timeout_s)) {
        return fail(ErrorCode::stage_silent, fmt::format("only {} of {} messages came on {}",
                                                         received_, options_.count, topic_));
      }
    }
    return success();
  }

  Session& session_;
  const std::string& topic_;
  const ReadOptions& options_;
  const TopicListener& listener_;
  int received_ = 0;
  int before_ = 0;  // received at the last tick
  bool done_ = false;
  Steady::time_point last_;  // when the last tick saw a new message
};

}  // namespace

Status read_topic(Session& session, const ReadOptions& options, const TopicListener& listener) {
  auto name = full_topic_name(options.topic);
  if (!name) return name.error();
  // Readers may be discovered first, but only writers tell what can be asked for.
  const auto written = [&] {
    return std::ranges::any_of(session.endpoints_of(*name), &runtime::EndpointInfo::writer);
  };
  if (!session.wait_for(options.timeout_s, written) && session.endpoints_of(*name).empty()) {
    if (Interruptible::interrupted()) return success();
    return session.no_topic(*name, options.timeout_s);
  }
  const Found found = choose(session.endpoints_of(*name), listener);
  if (auto status = listener.begin(found.type); !status) return status;
  return Follower(session, *name, options, listener).follow(found);
}

}  // namespace goshawk::introspection
