#include "records.hpp"

#include <zlib.h>

namespace goshawk::recording {

void put(Out& out, const Schema& schema) {
  out.record(Opcode::schema, [&](Out& o) {
    o.number(schema.id).text(schema.name).text(schema.encoding).text(schema.data);
  });
}

void put(Out& out, const Channel& channel) {
  out.record(Opcode::channel, [&](Out& o) {
    o.number(channel.id).number(channel.schema_id).text(channel.topic);
    o.text(channel.message_encoding).sized<std::uint32_t>([&](Out& map) {
      for (const auto& [key, value] : channel.metadata) map.text(key).text(value);
    });
  });
}

void put(Out& out, const MessageView& message) {
  out.record(Opcode::message, [&](Out& o) {
    o.number(message.channel_id).number(message.sequence);
    o.number(message.log_time_ns).number(message.publish_time_ns).raw(message.data);
  });
}

std::optional<Schema> schema_of(View content) {
  In in(content);
  Schema schema;
  schema.id = in.number<std::uint16_t>();
  schema.name = in.text();
  schema.encoding = in.text();
  schema.data = in.text();
  if (!in.good() || schema.id == 0) return {};
  return schema;
}

std::optional<Channel> channel_of(View content) {
  In in(content);
  Channel channel;
  channel.id = in.number<std::uint16_t>();
  channel.schema_id = in.number<std::uint16_t>();
  channel.topic = in.text();
  channel.message_encoding = in.text();
  In map(in.raw(in.number<std::uint32_t>()));
  while (in.good() && map.good() && map.left() > 0) {
    std::string key = map.text();
    channel.metadata[std::move(key)] = map.text();
  }
  if (!in.good() || !map.good()) return {};
  return channel;
}

std::optional<MessageView> message_of(View content) {
  In in(content);
  MessageView message;
  message.channel_id = in.number<std::uint16_t>();
  message.sequence = in.number<std::uint32_t>();
  message.log_time_ns = in.number<std::uint64_t>();
  message.publish_time_ns = in.number<std::uint64_t>();
  message.data = in.raw(in.left());
  if (!in.good()) return {};
  return message;
}

std::uint32_t crc32_of(View bytes, std::uint32_t crc) {
  return std::uint32_t(crc32_z(crc, bytes.data(), bytes.size()));
}

}  // namespace goshawk::recording
