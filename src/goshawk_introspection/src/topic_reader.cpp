#include "topic_reader.hpp"

#include <algorithm>
#include <iostream>
#include <set>

namespace goshawk::introspection {
namespace {

using Steady = std::chrono::steady_clock;

struct Found {
  std::string type;
  runtime::Qos qos;
};

// A reader may ask for no more than every writer offers; where nobody writes yet, for least.
Found choose(const std::vector<runtime::EndpointInfo>& endpoints) {
  std::vector<runtime::EndpointInfo> writers;
  std::set<std::string> types;
  for (const auto& e : endpoints) {
    if (e.writer) writers.push_back(e);
  }
  const auto& relevant = writers.empty() ? endpoints : writers;
  for (const auto& e : relevant) types.insert(e.type);
  Found found{relevant.front().type, runtime::Qos::best_effort(1000)};
  if (types.size() > 1) {
    std::cerr << "goshawk: " << relevant.front().topic << " has " << types.size()
              << " types; this reads " << found.type << std::endl;
  }
  found.qos.reliable =
      !writers.empty() && std::ranges::all_of(writers, &runtime::EndpointInfo::reliable);
  found.qos.transient_local =
      !writers.empty() && std::ranges::all_of(writers, &runtime::EndpointInfo::transient_local);
  if (found.qos.reliable) found.qos.depth = 100;
  return found;
}

std::string text(double value) {
  char buffer[32];
  std::snprintf(buffer, sizeof buffer, "%g", value);
  return buffer;
}

}  // namespace

int read_topic(const CommonOptions& common, const ReadOptions& options,
               const std::function<int(const std::string& type)>& begin,
               const std::function<bool(const RawMessage&)>& message,
               const std::function<void()>& tick) {
  auto name = full_topic_name(options.topic);
  if (!name) return say_wrong_call(name.error().message);
  auto session = Session::open();
  if (!session) return say_wrong_call(session.error().message);
  auto& s = **session;
  // Readers may be discovered first, but only writers tell what can be asked for.
  const auto written = [&] {
    return std::ranges::any_of(s.endpoints_of(*name), &runtime::EndpointInfo::writer);
  };
  if (!s.wait_for(common.timeout_s, written) && s.endpoints_of(*name).empty()) {
    if (Interruptible::interrupted()) return 0;
    return s.say_no_topic(*name, common.timeout_s);
  }
  const Found found = choose(s.endpoints_of(*name));
  if (const int status = begin(found.type); status != 0) return status;

  int received = 0;
  bool done = false;
  const auto type = runtime::raw_message_type(runtime::wire_type_name(found.type));
  s.node().subscribe_raw(
      *name, type, found.qos, [&](const void* data, const runtime::MessageInfo& info) {
        if (done) return;
        const auto& bytes = *static_cast<const std::vector<unsigned char>*>(data);
        ++received;
        done = !message({bytes, info.received_ns}) || received == options.count;
      });
  if (!s.wait_for(common.timeout_s, [&] { return received > 0; }) && received == 0 &&
      !Interruptible::interrupted()) {
    const std::string sentence =
        "no message came on " + *name + " within " + text(common.timeout_s) + " s";
    if (!options.patient) return say_nothing(sentence + "; --timeout waits longer");
    std::cerr << "goshawk: " << sentence << ": still waiting, Ctrl-C ends" << std::endl;
  }
  int before = received;
  auto last = Steady::now();
  s.node().every(1.0, [&] {
    if (received > before) last = Steady::now();
    before = received;
    if (!done) tick();
  });
  while (!done && !Interruptible::interrupted()) {
    s.wait_for(1.0, [&] { return done; });
    const std::chrono::duration<double> silent = Steady::now() - last;
    if (options.count > 0 && !done && received == before &&
        silent.count() > std::max(2.0, common.timeout_s)) {
      return say_nothing("only " + std::to_string(received) + " of " +
                         std::to_string(options.count) + " messages came on " + *name);
    }
  }
  return 0;
}

}  // namespace goshawk::introspection
