#include "goshawk/introspection/services.hpp"

#include <string_view>

namespace goshawk::introspection {
namespace {

// What is between prefix and suffix; empty unless both are there.
std::string between(std::string_view text, std::string_view prefix, std::string_view suffix) {
  if (text.size() <= prefix.size() + suffix.size()) return "";
  if (!text.starts_with(prefix) || !text.ends_with(suffix)) return "";
  text.remove_prefix(prefix.size());
  text.remove_suffix(suffix.size());
  return std::string(text);
}

std::string without(const std::string& type, std::string_view suffix) {
  return type.ends_with(suffix) ? type.substr(0, type.size() - suffix.size()) : type;
}

}  // namespace

std::optional<ServiceEnd> service_end(const runtime::EndpointInfo& e) {
  if (const auto name = between(e.topic, "rq/", "Request"); !name.empty()) {
    return ServiceEnd{"/" + name, without(e.type, "_Request"), !e.writer};
  }
  if (const auto name = between(e.topic, "rr/", "Reply"); !name.empty()) {
    return ServiceEnd{"/" + name, without(e.type, "_Response"), e.writer};
  }
  return std::nullopt;
}

std::map<std::string, ServiceSummary> services_of(
    const std::vector<runtime::EndpointInfo>& endpoints) {
  std::map<std::string, ServiceSummary> services;
  for (const auto& e : endpoints) {
    const auto end = service_end(e);
    if (!end) continue;
    ServiceSummary& service = services[end->name];
    service.types.insert(end->type);
    // Each end reads one of both topics, and writes the other.
    if (!e.writer) ++(end->is_server ? service.servers : service.clients);
  }
  return services;
}

}  // namespace goshawk::introspection
