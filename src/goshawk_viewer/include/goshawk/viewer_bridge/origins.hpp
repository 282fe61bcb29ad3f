#pragma once

#include <string>
#include <vector>

#include "goshawk/core/result.hpp"

namespace goshawk::viewer_bridge {

/// The pages that `goshawk view` serves on its default port, and Foxglove's web application.
inline constexpr const char* kDefaultOrigins =
    "http://127.0.0.1:8080,http://localhost:8080,"
    "https://app.foxglove.dev,https://studio.foxglove.dev";

/// The web pages that may connect. A browser names the page's origin (RFC 6454) and a page cannot
/// change it, so a page that a user happens to visit cannot fly the vehicle. A program names none.
class Origins {
 public:
  /// @param list origins such as "http://127.0.0.1:8080" with commas between them, or "any"
  /// @return invalid_parameter, naming the first entry that is not an origin
  static Result<Origins> parse(const std::string& list);

  /// Compares whole origins: scheme, host and port. @param origin empty: a program, which may
  bool allow(const std::string& origin) const;

 private:
  bool any_ = false;
  std::vector<std::string> allowed_;
};

}  // namespace goshawk::viewer_bridge
