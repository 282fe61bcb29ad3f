#pragma once

#include <charconv>
#include <istream>
#include <optional>
#include <streambuf>
#include <string>
#include <string_view>
#include <vector>

namespace goshawk::map_server {

/// "BT" of "maps/Floor.BT" is "bt"; empty without an ending
std::string lower_case_ending(const std::string& path);

/// @return the text behind a byte order mark of UTF-8, if it has one
std::string_view without_byte_order_mark(std::string_view text);

/// Takes lines and words off the front of a text.
class TextReader {
 public:
  /// Lines end as the first one does: with LF, CR LF, or CR alone (old Macintosh).
  explicit TextReader(std::string_view text);

  bool done() const { return rest_.empty(); }
  std::string_view rest() const { return rest_; }

  /// @return the next line without its end
  std::string_view line();

  /// @return the next word of the text, over the ends of lines; empty at the end
  std::string_view word();

 private:
  std::string_view rest_;
  char end_;
};

/// Words between blanks.
std::vector<std::string_view> split(std::string_view line);

/// A whole word as a number ("nan" and "inf" are numbers of type double), or nothing.
template <typename T>
std::optional<T> parse(std::string_view word) {
  if (!word.empty() && word.front() == '+') word.remove_prefix(1);
  T value{};
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (error != std::errc() || end != word.data() + word.size()) return {};
  return value;
}

/// An istream over bytes that are in memory, without a copy.
class MemoryStream : private std::streambuf, public std::istream {
 public:
  explicit MemoryStream(std::string_view bytes) : std::istream(static_cast<std::streambuf*>(this)) {
    char* begin = const_cast<char*>(bytes.data());  // streambuf's interface; never written to
    setg(begin, begin, begin + bytes.size());
  }
};

}  // namespace goshawk::map_server
