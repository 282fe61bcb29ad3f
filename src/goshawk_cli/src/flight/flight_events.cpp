#include "flight/flight_events.hpp"

#include <fmt/format.h>

#include <cerrno>
#include <cstring>

#include "goshawk/conversions/status.hpp"

namespace goshawk::cli {

Result<FlightEvents> FlightEvents::open(const std::string& file) {
  std::ofstream stream(file);
  if (!stream) {
    return fail(ErrorCode::io_failed,
                fmt::format("{} cannot be written: {}", file, std::strerror(errno)));
  }
  return FlightEvents(std::move(stream));
}

void FlightEvents::add(std::int64_t at_ns, const std::string& event, Json what) {
  Json line{{"at_ns", at_ns}, {"event", event}};
  line.update(what);
  // Flushed: the file is read during the flight, to wait for an event.
  file_ << line.dump(-1, ' ', false, Json::error_handler_t::replace) << std::endl;
}

void FlightEvents::navigator(std::int64_t at_ns, const goshawk_msgs::msg::NavigatorState& m) {
  Json what{{"state", conversions::navigator_state_word(m.state())},
            {"request_id", m.request_id()},
            {"flown_request_id", m.flown_request_id()},
            {"code", m.code()},
            {"message", m.message()}};
  if (what == navigator_) return;
  navigator_ = what;
  add(at_ns, "navigator", std::move(what));
}

void FlightEvents::tracker(std::int64_t at_ns, const goshawk_msgs::msg::TrackingState& m) {
  Json what{{"mode", conversions::tracking_mode_word(m.mode())}, {"request_id", m.request_id()}};
  if (what == tracker_) return;
  tracker_ = what;
  add(at_ns, "tracker", std::move(what));
}

void FlightEvents::report(std::int64_t at_ns, const goshawk_msgs::msg::StageReport& m) {
  if (m.code() == "ok" && m.request_id() != 0) return;
  add(at_ns, "report",
      {{"node", m.node()},
       {"request_id", m.request_id()},
       {"code", m.code()},
       {"message", m.message()}});
}

}  // namespace goshawk::cli
