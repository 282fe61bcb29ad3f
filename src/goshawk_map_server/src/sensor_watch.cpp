#include "goshawk/map_server/sensor_watch.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace goshawk::map_server {

void SensorWatch::saw(const std::string& frame, std::size_t returns, std::size_t far_returns,
                      std::int64_t now_ns) {
  const bool is_new = !sensors_.contains(frame);
  if (is_new && sensors_.size() == kMostSensors) return;
  Sensor& sensor = sensors_[frame];
  sensor.scan_ns = now_ns;
  sensor.returns = returns;
  const bool sees = far_returns > 0 && double(far_returns) >= kSeeing_share * double(returns);
  if (is_new || sees) sensor.seeing_ns = now_ns;
}

SensorWatch::State SensorWatch::state_of(const Sensor& sensor, std::int64_t now_ns) const {
  const double timeout_ns = 1e9 * timeout_s_;
  if (double(now_ns - sensor.scan_ns) > timeout_ns) return State::silent;
  return double(now_ns - sensor.seeing_ns) > timeout_ns ? State::blind : State::seeing;
}

std::string SensorWatch::sentence(const std::string& frame, const Sensor& sensor, State state,
                                  std::int64_t now_ns) {
  const double silent_s = 1e-9 * double(now_ns - sensor.scan_ns);
  const double blind_s = 1e-9 * double(now_ns - sensor.seeing_ns);
  switch (state) {
    case State::silent:
      return fmt::format(
          "no scan of sensor '{}' has gone into the map for {:.1f} s: what it saw "
          "stays, and grows old. Check that it publishes, and its stamps",
          frame, silent_s);
    case State::blind:
      return fmt::format("sensor '{}' has seen nothing for {:.1f} s ({}): is its lens covered?",
                         frame, blind_s,
                         sensor.returns == 0 ? std::string("no returns")
                                             : fmt::format("returns nearer than {:g} m", kNear_m));
    case State::seeing:
      break;
  }
  return fmt::format("sensor '{}' sees again", frame);
}

std::vector<SensorWatch::News> SensorWatch::news(std::int64_t now_ns) {
  std::vector<News> all;
  if (!(timeout_s_ > 0.0)) return all;
  for (auto& [frame, sensor] : sensors_) {
    const State state = state_of(sensor, now_ns);
    if (state == sensor.told) continue;
    sensor.told = state;
    News news{{}, sentence(frame, sensor, state, now_ns)};
    if (state != State::seeing) news.fault = fail(ErrorCode::stage_silent, news.message);
    all.push_back(std::move(news));
  }
  return all;
}

}  // namespace goshawk::map_server
