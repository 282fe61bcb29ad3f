#include "memory.hpp"

#include <fmt/format.h>

#include <cstring>

#include "goshawk/conversions/status.hpp"
#include "goshawk/mission_messages/messages.hpp"
#include "goshawk/runtime/message_type.hpp"
#include "goshawk/stage/memory_file.hpp"

namespace goshawk::mission {
namespace {

constexpr std::string_view kKind = "goshawk mission memory 1";

/// What stands before the two messages.
struct Head {
  std::int64_t sent_after_ns = 0;
  std::uint64_t mission_size = 0;  // [byte] of the first message; the second is the rest
  std::uint64_t taken = 0;
};

Error not_a_mission() {
  return fail(ErrorCode::io_failed, "it does not hold a valid mission");
}

}  // namespace

stage::MemoryBytes to_bytes(const Memory& memory) {
  Progress progress{.state = memory.state, .waypoint = memory.next + 1, .reason = memory.reason};
  const stage::MemoryBytes mission = runtime::encode(to_msg(memory.mission, 0));
  const stage::MemoryBytes state = runtime::encode(to_msg(memory.mission, progress, 0));
  const Head head{memory.sent_after_ns, mission.size(), memory.taken ? 1U : 0U};
  stage::MemoryBytes bytes(sizeof head);
  std::memcpy(bytes.data(), &head, sizeof head);
  bytes.insert(bytes.end(), mission.begin(), mission.end());
  bytes.insert(bytes.end(), state.begin(), state.end());
  return bytes;
}

Result<Memory> from_bytes(const stage::MemoryBytes& bytes) {
  Head head;
  if (bytes.size() < sizeof head) return not_a_mission();
  std::memcpy(&head, bytes.data(), sizeof head);
  const auto begin = bytes.begin() + std::ptrdiff_t(sizeof head);
  if (head.mission_size > std::uint64_t(bytes.end() - begin)) return not_a_mission();
  const auto middle = begin + std::ptrdiff_t(head.mission_size);
  goshawk_msgs::msg::Mission mission_message;
  goshawk_msgs::msg::MissionState state;
  if (!runtime::decode(stage::MemoryBytes(begin, middle), mission_message) ||
      !runtime::decode(stage::MemoryBytes(middle, bytes.end()), state)) {
    return not_a_mission();
  }
  auto mission = from_msg(mission_message);
  if (!mission || !check(*mission) || state.waypoint() == 0 ||
      state.waypoint() > mission->waypoints.size()) {
    return not_a_mission();
  }
  return Memory{.mission = *std::move(mission),
                .state = mission_state_of(state.state()),
                .next = state.waypoint() - 1,
                .taken = head.taken != 0,
                .sent_after_ns = head.sent_after_ns,
                .reason = {conversions::error_code_of(state.code()), state.message()}};
}

Status write_memory(const std::string& path, const Memory& memory) {
  return stage::replace_file(path, stage::framed(kKind, to_bytes(memory)));
}

Result<Memory> read_memory(const std::string& path) {
  const auto bytes = stage::read_file(path);
  if (!bytes) return bytes.error();
  if (bytes->empty()) return Memory{};
  const auto content = stage::unframed(kKind, *bytes);
  auto memory = content ? from_bytes(*content) : Result<Memory>(content.error());
  if (memory) return memory;
  return fail(memory.code(), fmt::format("{} is not used: {}", path, memory.error().message));
}

}  // namespace goshawk::mission
