#include "payload_check.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cstdint>
#include <cstring>
#include <stdexcept>
#include <vector>

#include "goshawk/runtime/context.hpp"
#include "goshawk/runtime/schema.hpp"

namespace goshawk::runtime {
namespace {

using schema::Arity;
using schema::Field;
using schema::Kind;
using schema::size_of;
using schema::Type;

constexpr std::size_t kEncapsulation = 4;  // [byte] in front; alignment counts from behind it
constexpr std::size_t kString = sizeof(std::string), kVector = sizeof(std::vector<char>);
constexpr std::size_t kInPlace = 15;  // characters that a std::string stores in itself

/// [byte]
struct Size {
  std::size_t memory = 0;   // of the C++ object, without what it points at
  std::size_t largest = 1;  // alignment, which is that of its largest primitive in CDR as well
  std::size_t first = 1;    // alignment of its first primitive
  std::size_t wire = 0;     // if it is the same at every offset, padding included; else 0
};

std::size_t aligned(std::size_t at, std::size_t to) {
  return (at + to - 1) / to * to;
}

Size extent_of(const Type& type, const std::vector<Size>& inner) {
  Size all;
  std::size_t alignment = 1;
  bool same = true;
  for (const Field& field : type.fields) {
    Size one;
    if (field.kind == Kind::structure) {
      one = inner[std::size_t(field.type)];
    } else if (field.kind == Kind::string) {
      one = {kString, 4, 4, 0};
    } else {
      one.memory = one.largest = one.first = one.wire = size_of(field.kind);
    }
    if (field.arity == Arity::sequence) one = {kVector, 4, 4, 0};
    same = same && one.wire > 0;
    if (&field == &type.fields.front()) all.first = one.first;
    const std::size_t in_memory = one.wire > 0 ? one.largest : alignof(void*);
    alignment = std::max(alignment, in_memory);
    all.largest = std::max(all.largest, one.largest);
    all.memory = aligned(all.memory, in_memory) + field.size * one.memory;
    all.wire = aligned(all.wire, one.largest) + field.size * one.wire;
  }
  all.memory = aligned(all.memory, alignment);
  if (!same || all.first != all.largest || all.wire % all.largest != 0) all.wire = 0;
  return all;
}

const std::vector<Size>& sizes() {
  static const std::vector<Size> all = [] {
    std::vector<Size> list;
    for (const Type& type : schema::types()) list.push_back(extent_of(type, list));
    return list;
  }();
  return all;
}

/// One pass over the payload; the first fault ends it.
class Walk {
 public:
  Walk(std::span<const unsigned char> bytes, bool swap)
      : bytes_(bytes), swap_(swap), most_memory_(2 * bytes.size() + PayloadCheck::kFree) {}

  bool over(const Type& type) {
    return std::ranges::all_of(type.fields, [&](const Field& field) {
      if (over(field)) return true;
      path_ = std::string(field.name) + (path_.empty() ? "" : ".") + path_;
      return false;
    });
  }
  std::string fault() const { return path_ + " " + fault_; }

 private:
  std::size_t left() const { return bytes_.size() - at_; }

  bool over(const Field& field) {
    std::uint32_t count = field.size;
    if (field.arity == Arity::sequence && !claim(field, count)) return false;
    if (field.kind == Kind::structure) {
      const Size& size = sizes()[std::size_t(field.type)];
      if (size.wire > 0) return skip(size.largest, count, size.wire);
      const Type& type = schema::types()[std::size_t(field.type)];
      for (std::uint32_t k = 0; k < count; ++k) {
        if (!over(type)) return false;
      }
      return true;
    }
    if (field.kind != Kind::string) {
      const std::size_t size = size_of(field.kind);
      return skip(size, count, size);
    }
    for (std::uint32_t k = 0; k < count; ++k) {
      if (!over_string()) return false;
    }
    return true;
  }

  /// Reads the length of a sequence. That many elements must follow and fit into memory.
  bool claim(const Field& field, std::uint32_t& count) {
    if (!number(count)) return false;
    const bool structure = field.kind == Kind::structure;
    const std::size_t least =
        structure ? schema::types()[std::size_t(field.type)].least_size : size_of(field.kind);
    if (count > left() / least) {
      fault_ = fmt::format("claims {} elements of {} bytes or more, but the {} bytes left allow {}",
                           count, least, left(), left() / least);
      return false;
    }
    const std::size_t each = structure                    ? sizes()[std::size_t(field.type)].memory
                             : field.kind == Kind::string ? kString
                                                          : least;
    return take(count * each, fmt::format("{} elements", count));
  }

  /// Counts memory that the decoded message will take.
  bool take(std::size_t memory, const std::string& what) {
    memory_ += memory;
    if (memory_ <= most_memory_) return true;
    fault_ = fmt::format(
        "claims {}, which would take {} bytes of memory for a message of {}: {} are "
        "allowed",
        what, memory_, bytes_.size(), most_memory_);
    return false;
  }

  // Length with the closing zero, then the characters; some senders write an empty one as 0.
  bool over_string() {
    std::uint32_t length = 0;
    if (!number(length)) return false;
    if (length > left()) {
      fault_ = fmt::format("claims {} characters, but only {} bytes are left", length, left());
      return false;
    }
    at_ += length;
    memory_ += length > kInPlace ? length : 0;  // no more than on the wire
    return true;
  }

  bool skip(std::size_t alignment, std::size_t count, std::size_t size) {
    if (count == 0) return true;
    const std::size_t begin = aligned(at_, alignment);
    if (begin > bytes_.size() || count > (bytes_.size() - begin) / size) return cut_off();
    at_ = begin + count * size;
    return true;
  }

  bool number(std::uint32_t& value) {
    if (!skip(sizeof value, 1, sizeof value)) return false;
    std::memcpy(&value, bytes_.data() + at_ - sizeof value, sizeof value);
    if (swap_) value = __builtin_bswap32(value);
    return true;
  }

  bool cut_off() {
    fault_ = fmt::format("is cut off: the message ends after {} bytes", bytes_.size());
    return false;
  }

  std::span<const unsigned char> bytes_;
  bool swap_;
  std::size_t most_memory_;
  std::size_t memory_ = 0;
  std::size_t at_ = 0;
  std::string path_;  // to the field at fault, outermost first
  std::string fault_;
};

}  // namespace

PayloadCheck::PayloadCheck(std::string_view wire_name) {
  const auto types = schema::types();
  const auto found = std::ranges::find_if(
      types, [&](const Type& type) { return wire_type_name(type.name) == wire_name; });
  if (found == types.end()) throw std::logic_error("not a type of idl/: " + std::string(wire_name));
  type_ = &*found;
}

std::string PayloadCheck::fault_of(std::span<const unsigned char> payload) const {
  if (payload.size() < kEncapsulation || payload[0] != 0 || payload[1] > 1) {
    return "it does not begin with the encapsulation of plain CDR (0, 0 or 1, 0, 0)";
  }
  const bool big_endian = payload[1] == 0;
  Walk walk(payload.subspan(kEncapsulation),
            big_endian != (std::endian::native == std::endian::big));
  return walk.over(*type_) ? "" : walk.fault();
}

}  // namespace goshawk::runtime
