#pragma once

#include <array>
#include <concepts>
#include <cstring>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

#include "goshawk/core/result.hpp"
#include "goshawk/px4_wire/definitions.hpp"

namespace goshawk::px4 {

using Bytes = std::vector<unsigned char>;  // with the 4 bytes of CDR encapsulation in front
inline constexpr std::size_t kHeaderSize = 4;

namespace detail {

template <typename T>
constexpr Scalar scalar_of() {
  if constexpr (std::same_as<T, bool>) return Scalar::boolean;
  if constexpr (std::same_as<T, char>) return Scalar::character;
  if constexpr (std::same_as<T, std::uint8_t>) return Scalar::uint8;
  if constexpr (std::same_as<T, std::int8_t>) return Scalar::int8;
  if constexpr (std::same_as<T, std::uint16_t>) return Scalar::uint16;
  if constexpr (std::same_as<T, std::uint32_t>) return Scalar::uint32;
  if constexpr (std::same_as<T, std::uint64_t>) return Scalar::uint64;
  if constexpr (std::same_as<T, float>) return Scalar::float32;
}

/// @throws std::logic_error unless the field has this type and count
const Field& field_of(const Layout& layout, const char* name, Scalar scalar, std::size_t count);

/// @return invalid_input: too short, big-endian, or a bool that is neither 0 nor 1
Status check_bytes(const Layout& layout, std::string_view type,
                   std::span<const unsigned char> bytes);

/// Visits the fields of a struct: `move` copies between the field's bytes and the value.
template <typename Move>
class Walker {
 public:
  Walker(const Layout& layout, Move move) : layout_(layout), move_(move) {}

  template <typename T>
  void operator()(const char* name, T& value) {
    using Plain = std::remove_const_t<T>;
    const Field& field = field_of(layout_, name, scalar_of<Plain>(), 1);
    move_(kHeaderSize + field.offset, &value, sizeof value);
  }
  template <typename T, std::size_t N>
  void operator()(const char* name, std::array<T, N>& value) {
    walk_array<T, N>(name, value);
  }
  template <typename T, std::size_t N>
  void operator()(const char* name, const std::array<T, N>& value) {
    walk_array<T, N>(name, value);
  }
  template <typename T>
  void optional(const char* name, T& value) {
    if (layout_.find(name) != nullptr) (*this)(name, value);
  }

 private:
  template <typename T, std::size_t N, typename Array>
  void walk_array(const char* name, Array& value) {
    const Field& field = field_of(layout_, name, scalar_of<T>(), N);
    move_(kHeaderSize + field.offset, value.data(), sizeof value);
  }

  const Layout& layout_;
  Move move_;
};

}  // namespace detail

/// @param bytes resized and overwritten: allocates only when it never was as large. What the struct
///        does not have is zero, the timestamp included: PX4 then stamps when the message arrives
template <typename Message>
void encode(const Layout& layout, const Message& message, Bytes& bytes) {
  bytes.assign(kHeaderSize + layout.size(), 0);
  bytes[1] = 1;  // little-endian
  const auto move = [&](std::size_t at, const void* value, std::size_t size) {
    std::memcpy(bytes.data() + at, value, size);
  };
  detail::Walker walker(layout, move);
  Message::fields(message, walker);
}

/// @return invalid_input if the bytes are not of this layout
template <typename Message>
Result<Message> decode(const Layout& layout, const Bytes& bytes) {
  if (auto status = detail::check_bytes(layout, Message::kType, bytes); !status) {
    return status.error();
  }
  Message message;
  const auto move = [&](std::size_t at, void* value, std::size_t size) {
    std::memcpy(value, bytes.data() + at, size);
  };
  detail::Walker walker(layout, move);
  Message::fields(message, walker);
  return message;
}

/// The text of a fixed array of characters, up to its zero.
template <std::size_t N>
std::string text_of(const std::array<char, N>& characters) {
  return {characters.data(), strnlen(characters.data(), N)};
}
/// @pre text is shorter than N
template <std::size_t N>
std::array<char, N> characters_of(std::string_view text) {
  std::array<char, N> characters{};
  std::memcpy(characters.data(), text.data(), std::min(text.size(), N - 1));
  return characters;
}

}  // namespace goshawk::px4
