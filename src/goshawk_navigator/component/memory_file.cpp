#include "memory_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string_view>

#include "goshawk/runtime/message_type.hpp"

namespace goshawk::navigator {
namespace {

namespace msg = goshawk_msgs::msg;
using Bytes = std::vector<unsigned char>;

constexpr std::string_view kMagic = "goshawk navigator memory 1\n";
constexpr std::size_t kMostLegs = 64;

/// FNV-1a
std::uint64_t checksum(const unsigned char* bytes, std::size_t count) {
  std::uint64_t hash = 0xCBF29CE484222325ULL;
  for (std::size_t i = 0; i < count; ++i) hash = (hash ^ bytes[i]) * 0x100000001B3ULL;
  return hash;
}

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
  return fail(ErrorCode::io_failed, "it is cut off, was changed, or is of another version");
}

}  // namespace

Bytes to_bytes(const StoredMemory& stored) {
  Bytes bytes(kMagic.begin(), kMagic.end());
  const Memory& memory = stored.memory;
  put(bytes, std::uint8_t(memory.state));
  put(bytes, std::uint8_t(memory.open));
  put(bytes, memory.newest_id);
  for (const double value : {memory.goal.position_map.x(), memory.goal.position_map.y(),
                             memory.goal.position_map.z(), memory.goal.yaw_rad}) {
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
  put(bytes, checksum(bytes.data(), bytes.size()));
  return bytes;
}

Result<StoredMemory> from_bytes(const Bytes& bytes) {
  constexpr std::size_t kSum = sizeof(std::uint64_t);
  if (bytes.size() < kMagic.size() + kSum) return broken();
  const unsigned char* end = bytes.data() + bytes.size() - kSum;
  std::uint64_t sum = 0;
  std::memcpy(&sum, end, kSum);
  if (!std::equal(kMagic.begin(), kMagic.end(), bytes.begin()) ||
      sum != checksum(bytes.data(), bytes.size() - kSum)) {
    return broken();
  }
  Reader reader(bytes.data() + kMagic.size(), end);
  StoredMemory stored;
  const auto state = reader.number<std::uint8_t>();
  stored.memory.state = State(state);
  stored.memory.open = reader.number<std::uint8_t>() != 0;
  stored.memory.newest_id = reader.number<std::uint64_t>();
  for (double& value : stored.memory.goal.position_map) value = reader.number<double>();
  stored.memory.goal.yaw_rad = reader.number<double>();
  const auto code = reader.number<std::uint64_t>();
  if (code >= all_error_codes().size()) return broken();
  stored.memory.reason = {all_error_codes()[code], reader.text()};
  const auto legs = reader.number<std::uint64_t>();
  for (std::uint64_t i = 0; i < std::min<std::uint64_t>(legs, kMostLegs) && reader.good(); ++i) {
    stored.legs.push_back(reader.message<PublishedLeg>());
  }
  const Goal& goal = stored.memory.goal;
  const bool sensible = state <= std::uint8_t(State::failed) && goal.position_map.allFinite() &&
                        std::isfinite(goal.yaw_rad) && legs <= kMostLegs;
  if (!reader.at_end() || !sensible) return broken();
  return stored;
}

Status write_memory(const std::string& path, const StoredMemory& stored) {
  const Bytes bytes = to_bytes(stored);
  const std::string draft = path + ".new";
  std::ofstream file(draft, std::ios::binary | std::ios::trunc);
  file.write(reinterpret_cast<const char*>(bytes.data()), std::streamsize(bytes.size()));
  file.close();
  std::error_code error;
  if (file) std::filesystem::rename(draft, path, error);
  if (file && !error) return success();
  return fail(ErrorCode::io_failed,
              fmt::format("{} cannot be written ({}): a restarted navigator will not know its goal",
                          path, error ? error.message() : std::strerror(errno)));
}

Result<StoredMemory> read_memory(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) {
    const std::string why = std::strerror(errno);
    std::error_code error;  // of a folder that may not be looked into
    if (!std::filesystem::exists(path, error) && !error) return StoredMemory{};
    return fail(ErrorCode::io_failed, path + " cannot be read: " + why);
  }
  auto stored = from_bytes(Bytes(std::istreambuf_iterator<char>(file), {}));
  if (stored) return stored;
  return fail(stored.code(), path + " is not used: " + stored.error().message);
}

}  // namespace goshawk::navigator
