#include "memory_file.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <string_view>

#include "goshawk/runtime/message_type.hpp"
#include "goshawk/stage/memory_file.hpp"

namespace goshawk::navigator {
namespace {

using Bytes = stage::MemoryBytes;

constexpr std::string_view kKind = "goshawk navigator memory 2";
constexpr std::size_t kMostLegs = 64;

template <typename Number>
void put(Bytes& bytes, Number number) {
  std::array<unsigned char, sizeof number> raw;
  std::memcpy(raw.data(), &number, sizeof number);
  bytes.insert(bytes.end(), raw.begin(), raw.end());
}

/// Takes numbers and messages from the front; once one is missing, nothing more is there.
class Reader {
 public:
  Reader(const unsigned char* begin, const unsigned char* end) : at_(begin), end_(end) {}

  template <typename Number>
  Number number() {
    Number value{};
    if (!has(sizeof value)) return value;
    std::memcpy(&value, at_, sizeof value);
    at_ += sizeof value;
    return value;
  }
  template <typename Message>
  Message message() {
    Message m;
    const auto size = number<std::uint64_t>();
    if (!has(size)) return m;
    good_ = runtime::decode(Bytes(at_, at_ + size), m);
    at_ += size;
    return m;
  }
  std::string text() {
    const auto size = number<std::uint64_t>();
    if (!has(size)) return {};
    std::string text(at_, at_ + size);
    at_ += size;
    return text;
  }
  bool good() const { return good_; }
  bool at_end() const { return good_ && at_ == end_; }

 private:
  bool has(std::uint64_t count) {
    good_ = good_ && count <= std::uint64_t(end_ - at_);
    return good_;
  }

  const unsigned char* at_;
  const unsigned char* end_;
  bool good_ = true;
};

Error broken() {
  return fail(ErrorCode::io_failed, "its content is invalid");
}

}  // namespace

Bytes to_bytes(const StoredMemory& stored) {
  Bytes bytes;
  const Memory& memory = stored.memory;
  put(bytes, std::uint8_t(memory.state));
  put(bytes, std::uint8_t(memory.open));
  put(bytes, memory.newest_id);
  for (const double value :
       {memory.goal.position_map.x(), memory.goal.position_map.y(), memory.goal.position_map.z(),
        memory.goal.yaw_rad, memory.goal.v_max_m_s}) {
    put(bytes, value);
  }
  put(bytes, std::uint64_t(memory.reason.code));
  put(bytes, std::uint64_t(memory.reason.message.size()));
  bytes.insert(bytes.end(), memory.reason.message.begin(), memory.reason.message.end());
  put(bytes, std::uint64_t(stored.legs.size()));
  for (const PublishedLeg& leg : stored.legs) {
    const Bytes encoded = runtime::encode(leg);
    put(bytes, std::uint64_t(encoded.size()));
    bytes.insert(bytes.end(), encoded.begin(), encoded.end());
  }
  return stage::framed(kKind, bytes);
}

Result<StoredMemory> from_bytes(const Bytes& bytes) {
  const auto content = stage::unframed(kKind, bytes);
  if (!content) return content.error();
  Reader reader(content->data(), content->data() + content->size());
  StoredMemory stored;
  const auto state = reader.number<std::uint8_t>();
  stored.memory.state = State(state);
  stored.memory.open = reader.number<std::uint8_t>() != 0;
  stored.memory.newest_id = reader.number<std::uint64_t>();
  for (double& value : stored.memory.goal.position_map) value = reader.number<double>();
  stored.memory.goal.yaw_rad = reader.number<double>();
  stored.memory.goal.v_max_m_s = reader.number<double>();
  const auto code = reader.number<std::uint64_t>();
  if (code >= all_error_codes().size()) return broken();
  stored.memory.reason = {all_error_codes()[code], reader.text()};
  const auto legs = reader.number<std::uint64_t>();
  for (std::uint64_t i = 0; i < std::min<std::uint64_t>(legs, kMostLegs) && reader.good(); ++i) {
    stored.legs.push_back(reader.message<PublishedLeg>());
  }
  const Goal& goal = stored.memory.goal;
  const bool sensible = state <= std::uint8_t(State::held) && goal.position_map.allFinite() &&
                        std::isfinite(goal.yaw_rad) && std::isfinite(goal.v_max_m_s) &&
                        legs <= kMostLegs;
  if (!reader.at_end() || !sensible) return broken();
  return stored;
}

Status write_memory(const std::string& path, const StoredMemory& stored) {
  return stage::replace_file(path, to_bytes(stored));
}

Result<StoredMemory> read_memory(const std::string& path) {
  const auto bytes = stage::read_file(path);
  if (!bytes) return bytes.error();
  if (bytes->empty()) return StoredMemory{};
  auto stored = from_bytes(*bytes);
  if (stored) return stored;
  return fail(stored.code(), path + " is not used: " + stored.error().message);
}

}  // namespace goshawk::navigator
