#pragma once

#include <string>
#include <vector>

#include "goshawk/recording/reader.hpp"
#include "goshawk/recording_tools/layout.hpp"
#include "goshawk/runtime/message_type.hpp"

namespace goshawk::recording {

/// Reads the messages of a topic in any namespace ("path": of /path and of /uav1/path), in the
/// order of their log times. Callers link goshawk_recording::tools.
/// @return all that decode as Message; io_failed if the file cannot be read;
/// invalid_input that names the topic if there is none, or if another version recorded it
template <typename Message>
Result<std::vector<Message>> messages_of(Reader& reader, const std::string& topic) {
  ReadOptions options;
  options.channels.emplace();
  for (const auto& [id, channel] : reader.channels()) {
    if (channel.topic.ends_with("/" + topic)) options.channels->insert(id);
  }
  if (const Status same = check_layout(reader, *options.channels); !same) return same.error();
  std::vector<Message> messages;
  const auto read = reader.read(options, [&](const MessageView& m) {
    Message message;
    if (runtime::decode<Message>({m.data.begin(), m.data.end()}, message)) {
      messages.push_back(std::move(message));
    }
    return true;
  });
  if (!read) return read.error();
  if (!messages.empty()) return messages;
  return fail(ErrorCode::invalid_input,
              "the recording has no messages on " + topic + ": record a flight with it");
}

}  // namespace goshawk::recording
