#pragma once

#include <array>

#include "goshawk/core/words.hpp"

namespace goshawk::px4 {

/// PX4 releases whose messages are known. 1.14 has no external modes and answers no format check.
enum class Release { v1_15, v1_16, v1_17, v1_18 };

constexpr auto words_of(Release) {
  return std::to_array<Named<Release>>({{Release::v1_15, "1.15"},
                                        {Release::v1_16, "1.16"},
                                        {Release::v1_17, "1.17"},
                                        {Release::v1_18, "1.18"}});
}

}  // namespace goshawk::px4
