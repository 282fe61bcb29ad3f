#include "goshawk/px4_wire/codec.hpp"

#include <fmt/format.h>

#include <stdexcept>

namespace goshawk::px4::detail {

const Field& field_of(const Layout& layout, const char* name, Scalar scalar, std::size_t count) {
  const Field* field = layout.find(name);
  if (field != nullptr && field->scalar == scalar && field->count == count) return *field;
  throw std::logic_error(fmt::format("a PX4 message has no field {} of that type", name));
}

Status check_bytes(const Layout& layout, std::string_view type,
                   std::span<const unsigned char> bytes) {
  const auto invalid = [&](const std::string& why) {
    return fail(ErrorCode::invalid_input, fmt::format("PX4's {} is refused: {}", type, why));
  };
  if (bytes.size() < kHeaderSize + layout.size()) {
    return invalid(fmt::format("it has {} bytes, not {}: set px4_release to the release that flies",
                               bytes.size(), kHeaderSize + layout.size()));
  }
  if (bytes[0] != 0 || bytes[1] != 1) return invalid("it is not little-endian CDR");
  for (const Field& field : layout.fields()) {
    if (field.scalar == Scalar::boolean && bytes[kHeaderSize + field.offset] > 1) {
      return invalid(fmt::format("{} is neither 0 nor 1: set px4_release to the release that flies",
                                 field.name));
    }
  }
  return success();
}

}  // namespace goshawk::px4::detail
