#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

namespace goshawk::px4 {

/// Numbers as PX4's message definitions name them.
enum class Scalar : std::uint8_t {
  boolean,
  character,
  uint8,
  int8,
  uint16,
  int16,
  uint32,
  int32,
  uint64,
  int64,
  float32,
  float64
};

/// One field of a message on the wire.
struct Field {
  std::string_view name;
  Scalar scalar = Scalar::uint8;
  std::size_t count = 1;   // of an array; 1 for a number alone
  std::size_t offset = 0;  // [byte] behind the encapsulation header
};

/// Where each field of a message lies in its CDR bytes (XCDR1, little-endian, no key): all of PX4's
/// messages have a fixed size. PX4 compares layouts by the same hash.
class Layout {
 public:
  /// @param definition fields in their order, "uint64 timestamp; float32[3] position; ...". It must
  ///        outlive the layout. Five Events (ArmingCheckReply) are skipped as a whole
  /// @throws std::logic_error if it cannot be read: definitions are ours
  explicit Layout(std::string_view definition);

  /// @return nullptr if this release's message has no such field
  const Field* find(std::string_view name) const;
  const std::vector<Field>& fields() const { return fields_; }
  /// [byte] without the encapsulation header
  std::size_t size() const { return size_; }
  /// FNV-1a, 32 bit, of "TYPE NAME\n" for each field, those of a nested type behind it.
  std::uint32_t hash() const { return hash_; }

 private:
  void add(std::string_view type, std::string_view name);
  Field place(std::string_view type, std::string_view name);

  std::vector<Field> fields_;
  std::size_t size_ = 0;
  std::uint32_t hash_;
};

}  // namespace goshawk::px4
