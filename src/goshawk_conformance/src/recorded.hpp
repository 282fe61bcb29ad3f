#pragma once

#include <memory>
#include <optional>
#include <set>

#include "goshawk/conversions/grid.hpp"
#include "goshawk/recording/reader.hpp"
#include "goshawk/runtime/message_type.hpp"

namespace goshawk::conformance {

/// All messages of a topic in any namespace; those that are no such message are left out.
template <typename Message>
Result<std::vector<Message>> recorded_messages(recording::Reader& reader,
                                               const std::string& topic) {
  std::vector<Message> messages;
  recording::ReadOptions options;
  options.channels.emplace();
  for (const auto& [id, channel] : reader.channels()) {
    if (channel.topic.ends_with("/" + topic)) options.channels->insert(id);
  }
  const auto read = reader.read(options, [&](const recording::MessageView& m) {
    Message message;
    if (runtime::decode<Message>({m.data.begin(), m.data.end()}, message)) {
      messages.push_back(std::move(message));
    }
    return true;
  });
  if (!read) return read.error();
  return messages;
}

/// What a planning stage got and made of it, when it was recorded.
template <typename Input>
struct Recorded {
  std::vector<Input> inputs;
  std::set<std::uint64_t> solved;         // ids of requests that had a result
  std::shared_ptr<const VoxelGrid> grid;  // the newest whole map
};

/// @return invalid_input where the recording lacks the stage's inputs or a map
template <typename Input, typename Output>
Result<Recorded<Input>> load_recorded(const std::string& file, const char* input_topic,
                                      const char* output_topic) {
  auto reader = recording::Reader::open(file);
  if (!reader) return reader.error();
  auto inputs = recorded_messages<Input>(*reader, input_topic);
  if (!inputs) return inputs.error();
  const auto outputs = recorded_messages<Output>(*reader, output_topic);
  if (!outputs) return outputs.error();
  const auto maps = recorded_messages<goshawk_msgs::msg::VoxelGrid>(*reader, "map/voxels");
  if (!maps) return maps.error();
  if (inputs->empty() || maps->empty()) {
    return fail(ErrorCode::invalid_input, file + " has no messages on " +
                                              (maps->empty() ? "map/voxels" : input_topic) +
                                              ": record a flight with it");
  }
  auto grid = conversions::from_msg(maps->back());
  if (!grid) return grid.error();
  Recorded<Input> recorded;
  recorded.inputs = *std::move(inputs);
  for (const auto& output : *outputs) recorded.solved.insert(output.request().id());
  recorded.grid = std::make_shared<VoxelGrid>(*std::move(grid));
  return recorded;
}

}  // namespace goshawk::conformance
