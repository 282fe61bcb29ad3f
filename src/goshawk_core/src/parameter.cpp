#include "goshawk/core/parameter.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace goshawk {

void ParameterFaults::operator()(const char* name, double value, const char* unit, const char*,
                                 const Range& range) {
  if (std::isfinite(value) && range.contains(value)) return;
  char text[200];
  std::snprintf(text, sizeof text, "%s is %g%s%s and must be in %c%g, %g]", name, value,
                *unit == '\0' ? "" : " ", unit, range.above_lo ? '(' : '[', range.lo, range.hi);
  add(text);
}

void ParameterFaults::operator()(const char* name, double value, const char*, const char*,
                                 const Anything&) {
  if (!std::isfinite(value)) add(std::string(name) + " is not finite");
}

void ParameterFaults::operator()(const char* name, const std::string& value, const char*,
                                 const char*, const OneOf& words) {
  if (std::ranges::find(words.choices, value) != words.choices.end()) return;
  std::string fault = std::string(name) + " is '" + value + "' and must be one of";
  for (const auto& choice : words.choices) fault += " " + choice;
  add(fault);
}

void ParameterFaults::add(const std::string& fault) {
  text_ += (text_.empty() ? "" : "; ") + fault;
}

Status ParameterFaults::status(const std::string& prefix) const {
  if (text_.empty()) return success();
  return fail(ErrorCode::invalid_parameter, prefix + text_);
}

}  // namespace goshawk
