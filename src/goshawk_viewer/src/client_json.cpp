#include "goshawk/viewer_bridge/client_json.hpp"

#include <algorithm>

namespace goshawk::viewer_bridge {
namespace {

using OrderedJson = nlohmann::ordered_json;

constexpr int kDeepest = 64;  // no message is nested deeper

void rename_nanoseconds(OrderedJson& value) {
  if (!value.is_structured()) return;
  if (value.is_object() && value.size() == 2 && value.contains("sec") && value.contains("nsec")) {
    value = {{"sec", value["sec"]}, {"nanosec", value["nsec"]}};
    return;
  }
  for (auto& inner : value) rename_nanoseconds(inner);
}

}  // namespace

Result<OrderedJson> client_json(std::span<const unsigned char> bytes) {
  int deepest = 0;
  const auto watch = [&](int depth, OrderedJson::parse_event_t, OrderedJson&) {
    deepest = std::max(deepest, depth);
    return depth <= kDeepest;
  };
  auto json = OrderedJson::parse(bytes.begin(), bytes.end(), watch, false);
  if (json.is_discarded() && deepest <= kDeepest) {
    return fail(ErrorCode::invalid_input, "this is no JSON");
  }
  if (deepest > kDeepest) {
    return fail(ErrorCode::invalid_input, "this JSON is nested deeper than any message");
  }
  rename_nanoseconds(json);
  return json;
}

}  // namespace goshawk::viewer_bridge
