#pragma once

#include <memory>
#include <optional>
#include <set>

#include "goshawk/conversions/grid.hpp"
#include "goshawk/recording_tools/messages.hpp"

namespace goshawk::conformance {

/// Recorded inputs of a planning stage, and which of them it solved.
template <typename Input>
struct Recorded {
  std::vector<Input> inputs;
  std::set<std::uint64_t> solved;         // ids of requests that had a result
  std::shared_ptr<const VoxelGrid> grid;  // the newest whole map
};

/// @return invalid_input if the recording lacks the stage's inputs or a map
template <typename Input, typename Output>
Result<Recorded<Input>> load_recorded(const std::string& file, const char* input_topic,
                                      const char* output_topic) {
  auto reader = recording::Reader::open(file);
  if (!reader) return reader.error();
  auto inputs = recording::messages_of<Input>(*reader, input_topic);
  if (!inputs) return inputs.error();
  const auto maps = recording::messages_of<goshawk_msgs::msg::VoxelGrid>(*reader, "map/voxels");
  if (!maps) return maps.error();
  auto grid = conversions::from_msg(maps->back());
  if (!grid) return grid.error();
  Recorded<Input> recorded;
  recorded.inputs = *std::move(inputs);
  const auto outputs = recording::messages_of<Output>(*reader, output_topic);
  if (outputs) {
    for (const auto& output : *outputs) recorded.solved.insert(output.request().id());
  } else if (outputs.code() != ErrorCode::invalid_input) {  // that means that nothing was solved
    return outputs.error();
  }
  recorded.grid = std::make_shared<VoxelGrid>(*std::move(grid));
  return recorded;
}

}  // namespace goshawk::conformance
