#include "restamp.hpp"

#include <algorithm>
#include <bit>
#include <cstring>

namespace goshawk::recording {
namespace {

using namespace introspection;

constexpr std::size_t kEncapsulation = 4;  // [byte] in front; alignment counts from behind it
constexpr std::int64_t kSecond_ns = 1'000'000'000;

bool holds_stamps(const Field& field);
bool holds_stamps(const Type& type) {
  return type.name == "builtin_interfaces/msg/Time" ||
         std::ranges::any_of(type.fields, [](const Field& f) { return holds_stamps(f); });
}
bool holds_stamps(const Field& field) {
  return field.kind == Kind::structure && holds_stamps(all_types()[std::size_t(field.type)]);
}

class Shifter {
 public:
  Shifter(std::span<unsigned char> payload, bool swap, std::int64_t shift_ns)
      : payload_(payload), swap_(swap), shift_ns_(shift_ns) {}

  bool walk(const Type& type) {
    if (type.name == "builtin_interfaces/msg/Time") return shift();
    return std::ranges::all_of(type.fields, [this](const Field& f) { return walk(f); });
  }

  /// Stops after the last stamp: megabytes may follow.
  bool walk_to_last_stamp(const Type& type) {
    std::size_t last = 0;
    for (std::size_t k = 0; k < type.fields.size(); ++k) {
      if (holds_stamps(type.fields[k])) last = k + 1;
    }
    return std::ranges::all_of(type.fields.first(last), [this](const Field& f) { return walk(f); });
  }

 private:
  bool walk(const Field& field) {
    std::uint32_t count = field.size;
    if (field.arity == Arity::sequence && !read(count)) return false;
    if (field.kind == Kind::structure || field.kind == Kind::string) {
      const auto least =
          field.kind == Kind::string ? 4U : all_types()[std::size_t(field.type)].least_size;
      if (count > (payload_.size() - at_) / least) return false;
      for (std::uint32_t i = 0; i < count; ++i) {
        const bool good =
            field.kind == Kind::string ? skip_string() : walk(all_types()[std::size_t(field.type)]);
        if (!good) return false;
      }
      return true;
    }
    return count == 0 || skip(size_of(field.kind), std::uint64_t(count) * size_of(field.kind));
  }

  bool shift() {
    std::int32_t sec = 0;
    std::uint32_t nanosec = 0;
    if (!read(sec)) return false;
    const std::size_t place = at_ - 4;
    if (!read(nanosec)) return false;
    if (sec == 0 && nanosec == 0) return true;
    const std::int64_t time_ns = sec * kSecond_ns + nanosec + shift_ns_;
    std::int64_t whole = time_ns / kSecond_ns;
    if (time_ns % kSecond_ns < 0) --whole;
    write(place, std::uint32_t(whole));
    write(place + 4, std::uint32_t(time_ns - whole * kSecond_ns));
    return true;
  }

  bool skip(std::size_t alignment, std::uint64_t size) {
    const std::size_t aligned = (at_ + alignment - 1) / alignment * alignment;
    if (aligned > payload_.size() || payload_.size() - aligned < size) return false;
    at_ = aligned + std::size_t(size);
    return true;
  }
  bool skip_string() {
    std::uint32_t length = 0;
    return read(length) && skip(1, length);
  }

  template <typename T>
  bool read(T& value) {
    if (!skip(sizeof(T), sizeof(T))) return false;
    std::uint32_t raw;
    std::memcpy(&raw, payload_.data() + at_ - 4, 4);
    value = T(swap_ ? __builtin_bswap32(raw) : raw);
    return true;
  }
  void write(std::size_t at, std::uint32_t value) {
    if (swap_) value = __builtin_bswap32(value);
    std::memcpy(payload_.data() + at, &value, 4);
  }

  std::span<unsigned char> payload_;
  bool swap_;
  std::int64_t shift_ns_;
  std::size_t at_ = 0;
};

}  // namespace

Status shift_stamps(const Type& type, Bytes& message, std::int64_t shift_ns) {
  const bool plain = message.size() >= kEncapsulation && message[0] == 0 && message[1] <= 1;
  if (plain) {
    const bool swap = (message[1] == 0) != (std::endian::native == std::endian::big);
    Shifter shifter(std::span<unsigned char>(message).subspan(kEncapsulation), swap, shift_ns);
    if (shifter.walk_to_last_stamp(type)) return success();
  }
  return fail(ErrorCode::invalid_input, "a recorded message is not a valid " +
                                            std::string(type.name) +
                                            ": its stamps cannot be moved");
}

}  // namespace goshawk::recording
