#pragma once

#include <limits>
#include <string>
#include <variant>
#include <vector>

#include "goshawk/core/result.hpp"
#include "goshawk/core/words.hpp"

namespace goshawk {

/// How a plain config struct tells its parameters. Each struct has one template
///
///     template <typename Self, typename Visitor>
///     void describe(Self& config, Visitor&& visit) {
///       visit("radius_m", config.radius_m, "m", "radius of the vehicle's body", Range{0.0, 10.0});
///       visit("planner", config.planner, "", "which search", Anything{});
///     }
///
/// found by argument-dependent lookup. Visitors read YAML, write docs, or print values; the
/// structs themselves know none of them. Value types: bool, int, double, std::string, and enums
/// that have words (words.hpp).

/// lo <= value <= hi; NaN is never in range.
struct Range {
  double lo = -std::numeric_limits<double>::infinity();
  double hi = std::numeric_limits<double>::infinity();
  bool above_lo = false;  // lo itself is excluded

  bool contains(double value) const { return (above_lo ? value > lo : value >= lo) && value <= hi; }
  static Range positive(double hi = std::numeric_limits<double>::max()) { return {0.0, hi, true}; }
};

/// One of these words, for a string; a choice that a core acts on is an enum instead.
struct OneOf {
  std::vector<std::string> choices;
};

/// Anything of the right type: finite, for a number; one of its words, for an enum.
struct Anything {};

/// Around one of the above: the value may change while the program runs, between two requests
/// (docs/adr/0008-parameters-at-run-time.md). All others hold from start to end.
///
///     visit("z_weight", config.z_weight, "", "what climbing costs", AtRunTime{Range{0.0, 1e3}});
template <typename Allowed>
struct AtRunTime : Allowed {};
template <typename Allowed>
AtRunTime(Allowed) -> AtRunTime<Allowed>;

template <typename Allowed>
inline constexpr bool is_at_run_time = false;
template <typename Allowed>
inline constexpr bool is_at_run_time<AtRunTime<Allowed>> = true;

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
  template <Worded E>
  void operator()(const char* name, E value, const char*, const char*, const Anything&) {
    if (to_word(value).empty()) add_not_listed(name, int(value), all_words<E>());
  }

  void add(const std::string& fault);
  bool empty() const { return text_.empty(); }

  /// @return invalid_parameter with every fault, behind `prefix`; or success
  Status status(const std::string& prefix = "") const;

 private:
  void add_not_listed(const char* name, int value, const std::vector<std::string>& words);

  std::string text_;
};

namespace detail {

template <typename T>
const T& comparable(const T& value) {
  return value;
}
template <Worded E>
std::string comparable(const E& value) {
  return std::string(to_word(value));
}

}  // namespace detail

/// Whether a config may follow on another while the program runs.
/// @return invalid_parameter that names each parameter which differs and is not AtRunTime
template <typename Config>
Status check_change(const Config& from, const Config& to) {
  using Value = std::variant<bool, int, double, std::string>;
  std::vector<Value> before;
  describe(from, [&](const char*, const auto& value, const char*, const char*, const auto&) {
    before.emplace_back(detail::comparable(value));
  });
  std::string fixed;
  std::size_t i = 0;
  describe(to, [&]<typename Allowed>(const char* name, const auto& value, const char*, const char*,
                                     const Allowed&) {
    const bool same = before[i++] == Value(detail::comparable(value));
    if (!same && !is_at_run_time<Allowed>) fixed += (fixed.empty() ? "" : ", ") + std::string(name);
  });
  if (fixed.empty()) return success();
  return fail(ErrorCode::invalid_parameter, fixed + " cannot change at run time: start anew");
}

}  // namespace goshawk
