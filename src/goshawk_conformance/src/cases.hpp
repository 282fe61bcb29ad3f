#pragma once

#include <set>
#include <string>
#include <vector>

#include "checks.hpp"
#include "world.hpp"

namespace goshawk::conformance {

/// A request and its expected answer.
template <typename Input>
struct Case {
  std::string name;  // "start in an obstacle"; empty for a good one
  Input input;
  std::set<std::string> codes;  // one of these for a bad one; empty: a result
};

template <typename Input>
struct Cases {
  std::vector<Case<Input>> good;
  std::vector<Case<Input>> bad;
  std::string no_map;  // code of a request that comes before any map; empty: it needs none
};

/// Each request has its own id above first_id, and a deadline only if the case is about deadlines.
Cases<msg::PlanRequest> search_cases(const World& world, Random& random, int count);
Cases<msg::Path> corridor_cases(const World& world, Random& random, int count);
Cases<msg::Corridor> trajectory_cases(const World& world, Random& random, int count);

inline msg::PlanRequest& request_of(msg::PlanRequest& m) {
  return m;
}
template <typename Message>
msg::PlanRequest& request_of(Message& m) {
  return m.request();
}

}  // namespace goshawk::conformance
