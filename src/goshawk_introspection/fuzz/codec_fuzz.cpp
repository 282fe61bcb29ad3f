// Any bytes as a message, and any text as a message in JSON: an error with a sentence, or the same
// message there and back. The first byte chooses the type and the way.
#include <cstdint>
#include <cstdlib>
#include <nlohmann/json.hpp>

#include "goshawk/introspection/codec.hpp"

namespace {

using namespace goshawk::introspection;
using Json = nlohmann::ordered_json;

void there_and_back(const Type& type, std::span<const unsigned char> bytes) {
  const auto json = cdr_to_json(type, bytes);
  if (!json) {
    if (json.error().message.empty()) std::abort();
    return;
  }
  const auto again = json_to_cdr(type, *json);
  if (!again) std::abort();
  const auto same = cdr_to_json(type, *again);
  if (!same || *same != *json) std::abort();
}

void from_json(const Type& type, std::string_view text) {
  const Json json = Json::parse(text, nullptr, false);
  if (json.is_discarded()) return;
  const auto bytes = json_to_cdr(type, json);
  if (bytes) {
    if (!cdr_to_json(type, *bytes)) std::abort();
  } else if (bytes.error().message.empty()) {
    std::abort();
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  const auto types = all_types();
  const Type& type = types[data[0] / 2 % types.size()];
  if (data[0] % 2 == 0) {
    there_and_back(type, {data + 1, size - 1});
  } else {
    from_json(type, {reinterpret_cast<const char*>(data + 1), size - 1});
  }
  return 0;
}
