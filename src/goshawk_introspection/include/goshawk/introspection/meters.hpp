#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>

#include "goshawk/introspection/topic_reader.hpp"

namespace goshawk::introspection {

/// The newest values and their statistics.
class Window {
 public:
  explicit Window(std::size_t most) : most_(most) {}
  void add(double value) {
    values_.push_back(value);
    if (values_.size() > most_) values_.pop_front();
  }
  std::size_t size() const { return values_.size(); }
  bool empty() const { return values_.empty(); }
  double front() const { return values_.front(); }
  double back() const { return values_.back(); }
  double sum() const {
    double total = 0.0;
    for (const double v : values_) total += v;
    return total;
  }
  /// @pre !empty(), here and below
  double mean() const { return sum() / double(size()); }
  double min() const { return *std::ranges::min_element(values_); }
  double max() const { return *std::ranges::max_element(values_); }
  /// Of the population, as in `ros2 topic hz`.
  double deviation() const {
    const double m = mean();
    double squares = 0.0;
    for (const double v : values_) squares += (v - m) * (v - m);
    return std::sqrt(squares / double(size()));
  }

 private:
  std::size_t most_;
  std::deque<double> values_;
};

/// Times between messages.
class RateMeter {
 public:
  explicit RateMeter(std::size_t window) : periods_s(window) {}
  void add(const RawMessage& message);
  /// [Hz], or none before two messages have come at different times.
  std::optional<double> rate_hz() const;

  Window periods_s;

 private:
  std::optional<std::int64_t> last_ns_;
};

/// Time from the header's stamp to the arrival.
class DelayMeter {
 public:
  explicit DelayMeter(std::size_t window) : delays_s(window) {}
  /// @return invalid_parameter for a type without a header
  static Status check(const std::string& type);
  void add(const RawMessage& message);

  Window delays_s;
};

/// Sizes and arrival times of messages.
class BandwidthMeter {
 public:
  explicit BandwidthMeter(std::size_t window) : sizes_byte(window), times_s_(window) {}
  void add(const RawMessage& message);
  double bytes_per_s() const;

  Window sizes_byte;

 private:
  Window times_s_;
};

}  // namespace goshawk::introspection
