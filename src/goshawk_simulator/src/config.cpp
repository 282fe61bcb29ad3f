#include "goshawk/simulator/config.hpp"

#include <cmath>
#include <cstdio>

namespace goshawk::simulator {
namespace {

// Collects what lies outside its described range.
class RangeCheck {
 public:
  template <typename T>
  void operator()(const char* name, const T& value, const char* unit, const char*,
                  const Range& range) {
    if (std::isfinite(double(value)) && range.contains(double(value))) return;
    char text[160];
    std::snprintf(text, sizeof text, "%s is %g %s and must be in %c%g, %g]", name, double(value),
                  unit, range.above_lo ? '(' : '[', range.lo, range.hi);
    add(text);
  }
  void operator()(const char* name, double value, const char*, const char*, const Anything&) {
    if (!std::isfinite(value)) add(std::string(name) + " is not finite");
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
  if (const auto vehicle = config.vehicle.check(); !vehicle) ranges.add(vehicle.error().message);
  if (ranges.faults().empty()) return success();
  return fail(ErrorCode::invalid_parameter, ranges.faults());
}

}  // namespace goshawk::simulator
