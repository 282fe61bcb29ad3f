#pragma once

#include <limits>
#include <string>
#include <vector>

#include "goshawk/core/result.hpp"

namespace goshawk {

/// How a plain config struct tells its parameters. Each struct has one template
///
///     template <typename Self, typename Visitor>
///     void describe(Self& config, Visitor&& visit) {
///       visit("radius_m", config.radius_m, "m", "radius of the vehicle's body", Range{0.0, 10.0});
///       visit("planner", config.planner, "", "which search", OneOf{{"jastar", "astar"}});
///     }
///
/// found by argument-dependent lookup. Visitors read YAML, write docs, or print values; the
/// structs themselves know none of them. Value types: bool, int, double, std::string.

/// lo <= value <= hi; NaN is never in range.
struct Range {
  double lo = -std::numeric_limits<double>::infinity();
  double hi = std::numeric_limits<double>::infinity();
  bool above_lo = false;  // lo itself is excluded

  bool contains(double value) const { return (above_lo ? value > lo : value >= lo) && value <= hi; }
  static Range positive(double hi = std::numeric_limits<double>::max()) { return {0.0, hi, true}; }
};

/// One of these words.
struct OneOf {
  std::vector<std::string> choices;
};

/// Anything of the right type (finite, for numbers).
struct Anything {};

/// The visitor that checks a config struct in the program: it collects every value that lies
/// outside of what describe() allows, and whatever else is wrong.
///
///     ParameterFaults faults;
///     describe(config, faults);
///     if (config.min_n > config.max_n) faults.add("min_n is above max_n");
///     return faults.status();
class ParameterFaults {
 public:
  void operator()(const char* name, double value, const char* unit, const char* text,
                  const Range& range);
  void operator()(const char* name, double value, const char* unit, const char* text,
                  const Anything&);
  void operator()(const char* name, const std::string& value, const char* unit, const char* text,
                  const OneOf& words);
  void operator()(const char*, const std::string&, const char*, const char*, const Anything&) {}

  void add(const std::string& fault);
  bool empty() const { return text_.empty(); }

  /// @return invalid_parameter with every fault, behind `prefix`; or success
  Status status(const std::string& prefix = "") const;

 private:
  std::string text_;
};

}  // namespace goshawk
