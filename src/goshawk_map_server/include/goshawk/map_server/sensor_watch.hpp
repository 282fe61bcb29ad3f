#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "goshawk/core/result.hpp"

namespace goshawk::map_server {

/// Notices sensors that fall silent (no scan comes) or blind (no scan sees anything: all returns
/// are missing, or right before the lens). What such a sensor saw last stays in the map and grows
/// old, so it is told, once, and told again when the sensor is back.
class SensorWatch {
 public:
  static constexpr double kNear_m = 0.3;         // returns up to here are a cover, not the world
  static constexpr double kSeeing_share = 0.01;  // of the returns must be farther
  static constexpr std::size_t kMostSensors = 16;

  /// @param timeout_s [s] without a scan, or without one that sees; 0: nothing is told
  explicit SensorWatch(double timeout_s) : timeout_s_(timeout_s) {}

  /// A scan that went into the map. @param frame names the sensor @param returns of the scan
  /// @param far_returns those farther than kNear_m @param now_ns [ns] of a clock that nobody sets
  void saw(const std::string& frame, std::size_t returns, std::size_t far_returns,
           std::int64_t now_ns);

  struct News {
    std::optional<Error> fault;  // stage_silent; none: the sensor is back
    std::string message;         // what is told, in both cases
  };
  /// What is to be told now: of each sensor at most one thing, and nothing twice.
  std::vector<News> news(std::int64_t now_ns);

 private:
  enum class State { seeing, blind, silent };
  struct Sensor {
    std::int64_t scan_ns = 0, seeing_ns = 0;  // of the last scan, and of the last one that saw
    std::size_t returns = 0;                  // of the last scan
    State told = State::seeing;
  };

  State state_of(const Sensor& sensor, std::int64_t now_ns) const;
  static std::string sentence(const std::string& frame, const Sensor& sensor, State state,
                              std::int64_t now_ns);

  double timeout_s_;
  std::map<std::string, Sensor> sensors_;  // by frame
};

}  // namespace goshawk::map_server
