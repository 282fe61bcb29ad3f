#pragma once

#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "goshawk/runtime/context.hpp"

namespace goshawk::introspection {

/// One end of a service of ROS 2, which DDS sees as two topics: rq/NAMERequest and rr/NAMEReply.
struct ServiceEnd {
  std::string name;  // full
  std::string type;  // "rcl_interfaces/srv/GetParameters"
  bool is_server = false;
};

/// @return nothing for an endpoint of a topic
std::optional<ServiceEnd> service_end(const runtime::EndpointInfo& endpoint);

struct ServiceSummary {
  std::set<std::string> types;
  int servers = 0;
  int clients = 0;
};

/// The services among endpoints, by name.
std::map<std::string, ServiceSummary> services_of(
    const std::vector<runtime::EndpointInfo>& endpoints);

}  // namespace goshawk::introspection
