#include "goshawk/px4_wire/layout.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <stdexcept>
#include <string>
#include <utility>

namespace goshawk::px4 {
namespace {

constexpr std::uint32_t kOffsetBasis = 0x811c9dc5, kPrime = 0x01000193;
constexpr std::string_view kEvents = "Event[5]";
constexpr std::array<std::pair<std::string_view, std::string_view>, 5> kEvent{
    {{"uint64", "timestamp"},
     {"uint32", "id"},
     {"uint16", "event_sequence"},
     {"uint8[25]", "arguments"},
     {"uint8", "log_levels"}}};

struct Kind {
  std::string_view word;
  Scalar scalar;
  std::size_t size;
};
constexpr std::array<Kind, 12> kKinds{{{"bool", Scalar::boolean, 1},
                                       {"char", Scalar::character, 1},
                                       {"uint8", Scalar::uint8, 1},
                                       {"int8", Scalar::int8, 1},
                                       {"uint16", Scalar::uint16, 2},
                                       {"int16", Scalar::int16, 2},
                                       {"uint32", Scalar::uint32, 4},
                                       {"int32", Scalar::int32, 4},
                                       {"uint64", Scalar::uint64, 8},
                                       {"int64", Scalar::int64, 8},
                                       {"float32", Scalar::float32, 4},
                                       {"float64", Scalar::float64, 8}}};

std::uint32_t hashed(std::uint32_t hash, std::string_view text) {
  for (const char c : text) hash = (hash ^ std::uint8_t(c)) * kPrime;
  return hash;
}

[[noreturn]] void unreadable(std::string_view what) {
  throw std::logic_error("a PX4 message definition is wrong at '" + std::string(what) + "'");
}

std::string_view trimmed(std::string_view text) {
  const auto first = text.find_first_not_of(' ');
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(' ') - first + 1);
}

std::size_t count_of(std::string_view type) {
  const auto open = type.find('[');
  if (open == std::string_view::npos) return 1;
  std::size_t count = 0;
  const auto [end, error] =
      std::from_chars(type.data() + open + 1, type.data() + type.size() - 1, count);
  if (error != std::errc() || *end != ']' || count == 0) unreadable(type);
  return count;
}

}  // namespace

Layout::Layout(std::string_view definition) : hash_(kOffsetBasis) {
  while (!definition.empty()) {
    const auto end = std::min(definition.find(';'), definition.size());
    const std::string_view entry = trimmed(definition.substr(0, end));
    definition.remove_prefix(std::min(end + 1, definition.size()));
    if (entry.empty()) continue;
    const auto space = entry.find(' ');
    if (space == std::string_view::npos) unreadable(entry);
    add(entry.substr(0, space), trimmed(entry.substr(space)));
  }
}

void Layout::add(std::string_view type, std::string_view name) {
  hash_ = hashed(hashed(hashed(hashed(hash_, type), " "), name), "\n");
  if (type != kEvents) {
    if (find(name) != nullptr) unreadable(name);
    return fields_.push_back(place(type, name));
  }
  for (const auto& [event_type, event_name] : kEvent) {  // a nested type counts once
    hash_ = hashed(hashed(hashed(hashed(hash_, event_type), " "), event_name), "\n");
  }
  for (int i = 0; i < 5; ++i) {
    for (const auto& [event_type, event_name] : kEvent) place(event_type, event_name);
  }
}

// The next bytes: each number lies at a multiple of its own size.
Field Layout::place(std::string_view type, std::string_view name) {
  const auto kind = std::ranges::find(kKinds, type.substr(0, type.find('[')), &Kind::word);
  if (kind == kKinds.end()) unreadable(type);
  const std::size_t offset = (size_ + kind->size - 1) / kind->size * kind->size;
  const Field field{name, kind->scalar, count_of(type), offset};
  size_ = offset + kind->size * field.count;
  return field;
}

const Field* Layout::find(std::string_view name) const {
  const auto found = std::ranges::find(fields_, name, &Field::name);
  return found == fields_.end() ? nullptr : &*found;
}

}  // namespace goshawk::px4
