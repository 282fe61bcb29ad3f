#include "goshawk/core/parameter.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

namespace goshawk {

void ParameterFaults::operator()(const char* name, double value, const char* unit, const char*,
                                 const Range& range) {
  if (std::isfinite(value) && range.contains(value)) return;
  add(fmt::format("{} is {:g}{}{} and must be in {}{:g}, {:g}]", name, value,
                  *unit == '\0' ? "" : " ", unit, range.above_lo ? '(' : '[', range.lo, range.hi));
}

void ParameterFaults::operator()(const char* name, double value, const char*, const char*,
                                 const Anything&) {
  if (!std::isfinite(value)) add(fmt::format("{} is not finite", name));
}

void ParameterFaults::operator()(const char* name, const std::string& value, const char*,
                                 const char*, const OneOf& words) {
  if (std::ranges::find(words.choices, value) != words.choices.end()) return;
  add(fmt::format("{} is '{}' and must be one of {}", name, value, fmt::join(words.choices, ", ")));
}

void ParameterFaults::add_not_listed(const char* name, int value,
                                     const std::vector<std::string>& words) {
  add(fmt::format("{} is {} and must be one of {}", name, value, fmt::join(words, ", ")));
}

void ParameterFaults::add(const std::string& fault) {
  text_ += (text_.empty() ? "" : "; ") + fault;
}

Status ParameterFaults::status(const std::string& prefix) const {
  if (text_.empty()) return success();
  return fail(ErrorCode::invalid_parameter, prefix + text_);
}

}  // namespace goshawk
