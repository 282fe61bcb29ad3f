#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

namespace goshawk {

/// A value of an enum and the word for it in configurations, messages to people and reports.
template <typename E>
struct Named {
  E value;
  std::string_view word;
};

/// An enum with words: a function beside it lists them, found by argument-dependent lookup.
///
///     enum class CornerRule { no_squeeze, squeeze };
///     constexpr auto words_of(CornerRule) {
///       return std::to_array<Named<CornerRule>>(
///           {{CornerRule::no_squeeze, "no_squeeze"}, {CornerRule::squeeze, "squeeze"}});
///     }
///
/// Words are read once, at the edge (parameters, options, messages); cores see the enum only.
template <typename E>
concept Worded = std::is_enum_v<E> && requires(E value) {
  words_of(value);
};

/// @return the word for the value; empty if the list lacks it (a cast from a wrong number)
template <Worded E>
constexpr std::string_view to_word(E value) {
  for (const auto& named : words_of(E{})) {
    if (named.value == value) return named.word;
  }
  return {};
}

/// @return the value that has this word, or nothing
template <Worded E>
constexpr std::optional<E> from_word(std::string_view word) {
  for (const auto& named : words_of(E{})) {
    if (named.word == word) return named.value;
  }
  return {};
}

/// All words, in the order of the list.
template <Worded E>
std::vector<std::string> all_words() {
  std::vector<std::string> words;
  for (const auto& named : words_of(E{})) words.emplace_back(named.word);
  return words;
}

}  // namespace goshawk
