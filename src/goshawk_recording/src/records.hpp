#pragma once

#include <array>
#include <bit>
#include <cstring>
#include <optional>
#include <string_view>

#include "goshawk/recording/format.hpp"

namespace goshawk::recording {

static_assert(std::endian::native == std::endian::little,
              "MCAP is little-endian, and so is this code");

inline constexpr std::array<unsigned char, 8> kMagic = {0x89, 'M', 'C', 'A', 'P', '0', '\r', '\n'};
inline constexpr std::size_t kRecordHead = 9;  // [byte] opcode and length

enum class Opcode : std::uint8_t {
  header = 1,
  footer = 2,
  schema = 3,
  channel = 4,
  message = 5,
  chunk = 6,
  message_index = 7,
  chunk_index = 8,
  statistics = 11,
  summary_offset = 14,
  data_end = 15
};

/// Appends numbers, strings and maps in MCAP's encoding.
class Out {
 public:
  explicit Out(Bytes& bytes) : bytes_(bytes) {}

  template <typename T>
  Out& number(T value) {
    static_assert(std::is_integral_v<T>);
    const auto at = bytes_.size();
    bytes_.resize(at + sizeof value);
    std::memcpy(bytes_.data() + at, &value, sizeof value);
    return *this;
  }
  Out& raw(View view) {
    bytes_.insert(bytes_.end(), view.begin(), view.end());
    return *this;
  }
  Out& text(std::string_view text) {
    number(std::uint32_t(text.size()));
    return raw({reinterpret_cast<const unsigned char*>(text.data()), text.size()});
  }
  /// Writes the length in bytes, then what `fill` appends.
  template <typename Length, typename Fill>
  Out& sized(Fill&& fill) {
    const auto at = bytes_.size();
    number(Length{0});
    fill(*this);
    const auto length = Length(bytes_.size() - at - sizeof(Length));
    std::memcpy(bytes_.data() + at, &length, sizeof length);
    return *this;
  }
  template <typename Fill>
  Out& record(Opcode opcode, Fill&& fill) {
    number(std::uint8_t(opcode));
    return sized<std::uint64_t>(fill);
  }

 private:
  Bytes& bytes_;
};

/// Reads them back. Bytes that do not fit set a flag; everything after them reads as zero.
class In {
 public:
  explicit In(View view) : view_(view) {}

  bool good() const { return good_; }
  std::size_t at() const { return at_; }
  std::size_t left() const { return view_.size() - at_; }

  template <typename T>
  T number() {
    T value{};
    const View bytes = raw(sizeof value);
    if (good_) std::memcpy(&value, bytes.data(), sizeof value);
    return value;
  }
  View raw(std::uint64_t size) {
    if (!good_ || size > left()) {
      good_ = false;
      return {};
    }
    const View part = view_.subspan(at_, std::size_t(size));
    at_ += std::size_t(size);
    return part;
  }
  std::string text() {
    const View part = raw(number<std::uint32_t>());
    return {part.begin(), part.end()};
  }

 private:
  View view_;
  std::size_t at_ = 0;
  bool good_ = true;
};

void put(Out& out, const Schema& schema);
void put(Out& out, const Channel& channel);
void put(Out& out, const MessageView& message);

/// Contents of records. @return nothing if the bytes are not such a record
std::optional<Schema> schema_of(View content);
std::optional<Channel> channel_of(View content);
std::optional<MessageView> message_of(View content);

/// CRC-32 as in MCAP. @param crc of the bytes before
std::uint32_t crc32_of(View bytes, std::uint32_t crc = 0);

}  // namespace goshawk::recording
