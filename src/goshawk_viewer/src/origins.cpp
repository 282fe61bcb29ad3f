#include "goshawk/viewer_bridge/origins.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <sstream>

namespace goshawk::viewer_bridge {
namespace {

std::string trimmed(const std::string& text) {
  const auto first = text.find_first_not_of(' ');
  if (first == std::string::npos) return {};
  return text.substr(first, text.find_last_not_of(' ') - first + 1);
}

// A scheme and what follows it, without a path. Applications have origins like "file://".
bool is_origin(const std::string& text) {
  const auto scheme = text.find("://");
  return scheme != std::string::npos && scheme > 0 &&
         text.find_first_of("/ ", scheme + 3) == std::string::npos;
}

}  // namespace

Result<Origins> Origins::parse(const std::string& list) {
  Origins origins;
  std::istringstream in(list);
  for (std::string entry; std::getline(in, entry, ',');) {
    entry = trimmed(entry);
    if (entry.empty()) continue;
    if (entry == "any") {
      origins.any_ = true;
    } else if (is_origin(entry)) {
      origins.allowed_.push_back(entry);
    } else {
      return fail(
          ErrorCode::invalid_parameter,
          fmt::format("origins: '{}' is not an origin; write it like http://127.0.0.1:8080, "
                      "without a path",
                      entry));
    }
  }
  return origins;
}

bool Origins::allow(const std::string& origin) const {
  return origin.empty() || any_ || std::ranges::find(allowed_, origin) != allowed_.end();
}

}  // namespace goshawk::viewer_bridge
