#pragma once

#include <algorithm>
#include <cstdlib>

namespace goshawk::goals {

/// How many flights a test flies: as usual, or as many as an environment variable says.
inline int count_of(const char* variable, int usual) {
  const char* wish = std::getenv(variable);
  return wish == nullptr ? usual : std::max(1, std::atoi(wish));
}

}  // namespace goshawk::goals
