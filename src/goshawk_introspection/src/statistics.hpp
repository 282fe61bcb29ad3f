#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <deque>

namespace goshawk::introspection {

/// The newest values, for hz, delay and bw.
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
  /// Of the population, as `ros2 topic hz` has it.
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

}  // namespace goshawk::introspection
