#pragma once

#include <concepts>
#include <string>
#include <type_traits>

#include "goshawk/core/parameter.hpp"

namespace goshawk::mission {

struct Config {
  double repeat_s = 1.0;
  double silence_s = 5.0;
  std::string memory_file;
};

template <typename Self, typename Visitor>
requires std::same_as<std::remove_const_t<Self>, Config>
void describe(Self& c, Visitor&& visit) {
  visit("repeat_s", c.repeat_s, "s",
        "a goal that the navigator has not taken is sent again after this time",
        AtRunTime{Range{0.1, 60.0}});
  visit(
      "silence_s", c.silence_s, "s",
      "after this time without the navigator taking a goal the mission says so; it goes on trying",
      AtRunTime{Range{0.1, 600.0}});
  visit("memory_file", c.memory_file, "",
        "file that keeps the mission and how far it is, so that a restarted stage goes on with it; "
        "a launch sets it; empty: none",
        Anything{});
}

}  // namespace goshawk::mission
