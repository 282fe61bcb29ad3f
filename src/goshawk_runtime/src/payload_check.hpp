#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>

namespace goshawk::runtime {

namespace schema {
struct Type;
}

/// Reads a message's bytes before they are decoded; takes no memory itself. The generated code
/// allocates as many elements as a sequence claims if there is at least a byte for each: a marker
/// takes 480 bytes of memory, so 20 MB of claims would take 10 GB.
class PayloadCheck {
 public:
  /// [byte] A decoded message may take twice its bytes and this much. Useful messages of idl/ take
  /// less; a million empty strings take more.
  static constexpr std::size_t kFree = 16 << 20;

  /// @param wire_name of a type of idl/; std::logic_error for any other
  explicit PayloadCheck(std::string_view wire_name);

  /// @param payload with its encapsulation
  /// @return what is wrong: which sequence or string claims how much, and how much is allowed;
  /// empty: nothing
  std::string fault_of(std::span<const unsigned char> payload) const;

 private:
  const schema::Type* type_;
};

}  // namespace goshawk::runtime
