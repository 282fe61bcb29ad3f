#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <nlohmann/json.hpp>
#include <optional>

#include "goshawk/introspection/codec.hpp"

namespace goshawk::introspection {
namespace {

using Json = nlohmann::ordered_json;
using Bytes = std::span<const unsigned char>;

constexpr std::size_t kEncapsulation = 4;  // [byte] in front; alignment counts from behind it
constexpr std::size_t kMostPadding = 3;    // [byte] that a sender may add at the end

/// Walks the payload once; the first fault ends the walk.
class Decoder {
 public:
  Decoder(Bytes payload, bool big_endian)
      : payload_(payload), swap_(big_endian != (std::endian::native == std::endian::big)) {}

  bool read(const Type& type, Json& out) {
    out = Json::object();
    for (const auto& field : type.fields) {
      Json value;
      if (!read(field, value)) {
        path_ = std::string(field.name) + (path_.empty() || path_[0] == '[' ? "" : ".") + path_;
        return false;
      }
      out.emplace(std::string(field.name), std::move(value));
    }
    return true;
  }

  std::size_t left() const { return payload_.size() - at_; }
  Error error(const Type& type) const {
    return fail(ErrorCode::invalid_input, "these bytes are not a valid " + std::string(type.name) +
                                              ": " + path_ + (path_.empty() ? "" : " ") + fault_);
  }
  void set_fault(std::string fault) { fault_ = std::move(fault); }

 private:
  bool read(const Field& field, Json& out) {
    if (field.arity == Arity::single) return read_one(field, out);
    std::uint32_t count = field.size;
    if (field.arity == Arity::sequence && !read_count(field, count)) return false;
    out = Json::array();
    out.get_ref<Json::array_t&>().reserve(count);  // read_count has checked that they fit
    for (std::uint32_t i = 0; i < count; ++i) {
      Json element;
      if (!read_one(field, element)) {
        path_ = fmt::format("[{}]{}{}", i, path_.empty() ? "" : ".", path_);
        return false;
      }
      out.push_back(std::move(element));
    }
    return true;
  }

  bool read_count(const Field& field, std::uint32_t& count) {
    if (!primitive(count)) return false;
    const std::uint32_t least = field.kind == Kind::structure
                                    ? all_types()[std::size_t(field.type)].least_size
                                    : size_of(field.kind);
    if (count <= left() / least) return true;
    fault_ = fmt::format("claims {} elements, but only {} bytes are left", count, left());
    return false;
  }

  bool read_one(const Field& field, Json& out) {
    switch (field.kind) {
      case Kind::boolean:
        return read_bool(out);
      case Kind::int8:
        return read_number<std::int8_t>(out);
      case Kind::uint8:
        return read_number<std::uint8_t>(out);
      case Kind::int16:
        return read_number<std::int16_t>(out);
      case Kind::uint16:
        return read_number<std::uint16_t>(out);
      case Kind::int32:
        return read_number<std::int32_t>(out);
      case Kind::uint32:
        return read_number<std::uint32_t>(out);
      case Kind::int64:
        return read_number<std::int64_t>(out);
      case Kind::uint64:
        return read_number<std::uint64_t>(out);
      case Kind::float32:
        return read_number<float>(out);
      case Kind::float64:
        return read_number<double>(out);
      case Kind::string:
        return read_string(out);
      case Kind::structure:
        return read(all_types()[std::size_t(field.type)], out);
    }
    throw std::logic_error("cdr_to_json: unknown kind");
  }

  template <typename T>
  bool primitive(T& value) {
    const std::size_t aligned = (at_ + sizeof(T) - 1) / sizeof(T) * sizeof(T);
    if (aligned > payload_.size() || payload_.size() - aligned < sizeof(T)) {
      fault_ = fmt::format("is cut off: the message ends after {} bytes", payload_.size());
      return false;
    }
    unsigned char raw[sizeof(T)];
    std::memcpy(raw, payload_.data() + aligned, sizeof(T));
    if (swap_) std::reverse(raw, raw + sizeof(T));
    std::memcpy(&value, raw, sizeof(T));
    at_ = aligned + sizeof(T);
    return true;
  }

  template <typename T>
  bool read_number(Json& out) {
    T value;
    if (!primitive(value)) return false;
    if constexpr (std::is_floating_point_v<T>) {
      if (std::isnan(value))
        out = "nan";
      else if (std::isinf(value))
        out = value > 0 ? "inf" : "-inf";
      else
        out = double(value);
    } else {
      out = value;
    }
    return true;
  }

  bool read_bool(Json& out) {
    std::uint8_t value;
    if (!primitive(value)) return false;
    if (value > 1) {
      fault_ = fmt::format("is a bool of value {}: it must be 0 or 1", value);
      return false;
    }
    out = value == 1;
    return true;
  }

  // Length with the closing zero, then the characters; some senders write an empty one as 0.
  bool read_string(Json& out) {
    std::uint32_t length;
    if (!primitive(length)) return false;
    if (length > left()) {
      fault_ = fmt::format("claims {} characters, but only {} bytes are left", length, left());
      return false;
    }
    const char* text = reinterpret_cast<const char*>(payload_.data() + at_);
    at_ += length;
    if (length > 0 && text[length - 1] == '\0') --length;
    if (std::find(text, text + length, '\0') != text + length) {
      fault_ = "contains a zero character, which ends a string on the wire";
      return false;
    }
    out = std::string(text, length);
    return true;
  }

  Bytes payload_;
  bool swap_;
  std::size_t at_ = 0;
  std::string path_;   // to the field at fault, outermost first
  std::string fault_;  // empty: none
};

// @return whether the payload is big-endian; nothing if it is not plain XCDR1
std::optional<bool> byte_order(Bytes bytes) {
  if (bytes.size() < kEncapsulation || bytes[0] != 0 || bytes[1] > 1) return std::nullopt;
  return bytes[1] == 0;
}

}  // namespace

Result<Json> cdr_to_json(const Type& type, Bytes bytes) {
  const auto big_endian = byte_order(bytes);
  if (!big_endian) {
    return fail(
        ErrorCode::invalid_input,
        fmt::format("these bytes are not a valid {}: they do not begin with the encapsulation "
                    "of plain CDR (0, 0 or 1, 0, 0)",
                    type.name));
  }
  Decoder decoder(bytes.subspan(kEncapsulation), *big_endian);
  Json json;
  if (!decoder.read(type, json)) return decoder.error(type);
  if (decoder.left() > kMostPadding) {
    decoder.set_fault(fmt::format("{} bytes are left over", decoder.left()));
    return decoder.error(type);
  }
  return json;
}

}  // namespace goshawk::introspection
