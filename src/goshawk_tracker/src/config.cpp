#include "goshawk/tracker/config.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "goshawk/core/vehicle.hpp"

namespace goshawk::tracker {
namespace {

// Collects what lies outside its described range.
class RangeCheck {
 public:
  void operator()(const char* name, double value, const char* unit, const char*,
                  const Range& range) {
    if (std::isfinite(value) && range.contains(value)) return;
    char text[160];
    std::snprintf(text, sizeof text, "%s is %g %s and must be in %c%g, %g]", name, value, unit,
                  range.above_lo ? '(' : '[', range.lo, range.hi);
    add(text);
  }

  void operator()(const char* name, const std::string& value, const char*, const char*,
                  const OneOf& words) {
    if (std::ranges::find(words.choices, value) != words.choices.end()) return;
    std::string fault = std::string(name) + " is '" + value + "' and must be one of";
    for (const auto& choice : words.choices) fault += " " + choice;
    add(fault);
  }

  void add(const std::string& fault) { faults_ += (faults_.empty() ? "" : "; ") + fault; }
  const std::string& faults() const { return faults_; }

 private:
  std::string faults_;
};

}  // namespace

Status check(const Config& config) {
  RangeCheck ranges;
  describe(config, ranges);
  const double weight_n = config.mass_kg * kGravity_m_s2;
  char text[120];
  if (config.max_thrust_n <= weight_n) {
    std::snprintf(text, sizeof text, "max_thrust_n (%g) does not lift the weight of %g N",
                  config.max_thrust_n, weight_n);
    ranges.add(text);
  }
  if (config.min_thrust_n >= weight_n) {
    std::snprintf(text, sizeof text, "min_thrust_n (%g) is not below the weight of %g N",
                  config.min_thrust_n, weight_n);
    ranges.add(text);
  }
  if (ranges.faults().empty()) return success();
  return fail(ErrorCode::invalid_parameter, ranges.faults());
}

}  // namespace goshawk::tracker
