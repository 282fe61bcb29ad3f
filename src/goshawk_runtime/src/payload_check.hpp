#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>

namespace goshawk::runtime {

namespace schema {
struct Type;
}

/// Goes through a message's bytes before they are decoded, and claims no memory itself. The
/// generated code makes room for as many elements as a sequence claims, where it has at least a
/// byte for each: a marker is 480 bytes in memory, so that 20 MB of claims would take 10 GB.
class PayloadCheck {
 public:
  /// A decoded message may take twice its bytes and this much [byte]: what comes of those of idl/
  /// that say anything takes less, a million empty strings take more.
  static constexpr std::size_t kFree = 16 << 20;

  /// @param wire_name of a type of idl/; std::logic_error for any other
  explicit PayloadCheck(std::string_view wire_name);

  /// @param payload with its encapsulation
  /// @return what is wrong: which sequence or string claims how much, and how much it may; empty
  /// where the bytes are all that the message says
  std::string fault_of(std::span<const unsigned char> payload) const;

 private:
  const schema::Type* type_;
};

}  // namespace goshawk::runtime
