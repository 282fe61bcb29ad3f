#include <zlib.h>

#include <cstdio>

#include <nlohmann/json.hpp>

#include "goshawk/introspection/codec.hpp"
#include "goshawk/recording_tools/replay.hpp"

namespace goshawk::recording {
namespace {

using Json = nlohmann::ordered_json;

Json value_of(const std::string& type_name, View data) {
  const auto type = introspection::find_type(type_name);
  if (!type) return nullptr;
  auto value = introspection::cdr_to_json(**type, data);
  return value ? *std::move(value) : Json(nullptr);
}

}  // namespace

Status print_messages(Reader& reader, const std::set<std::uint16_t>& channels) {
  return reader.read({.channels = channels}, [&](const MessageView& m) {
    const auto& channel = reader.channels().at(m.channel_id);
    const std::string& type = reader.schema_of(channel)->name;
    const Json line = {{"topic", channel.topic},
                       {"type", type},
                       {"log_time_s", double(m.log_time_ns) * 1e-9},
                       {"bytes", m.data.size()},
                       {"crc32", crc32(0, m.data.data(), uInt(m.data.size()))},
                       {"value", value_of(type, m.data)}};
    return std::printf("%s\n", line.dump(-1, ' ', false, Json::error_handler_t::replace).c_str()) >
           0;
  });
}

}  // namespace goshawk::recording
