#include "goshawk/path_search/config.hpp"

#include <algorithm>
#include <cmath>

namespace goshawk::path_search {
namespace {

std::string fault_of(double value, const Range& range) {
  if (range.contains(value)) return "";
  return std::to_string(value) + ": it must be " + (range.above_lo ? "above " : "at least ") +
         std::to_string(range.lo) + " and at most " + std::to_string(range.hi);
}

std::string fault_of(const std::string& value, const OneOf& words) {
  if (std::ranges::find(words.choices, value) != words.choices.end()) return "";
  std::string text = "'" + value + "': it must be one of";
  for (const std::string& word : words.choices) text += " " + word;
  return text;
}

std::string fault_of(bool, const Anything&) {
  return "";
}
std::string fault_of(const std::string&, const Anything&) {
  return "";
}

}  // namespace

Status check(const Config& config) {
  std::string faults;
  describe(config,
           [&](const char* name, const auto& value, const char*, const char*, const auto& domain) {
             const std::string fault = fault_of(value, domain);
             if (!fault.empty())
               faults += (faults.empty() ? "" : "; ") + std::string(name) + " is " + fault;
           });
  if (!faults.empty()) return fail(ErrorCode::invalid_parameter, faults);
  return success();
}

}  // namespace goshawk::path_search
