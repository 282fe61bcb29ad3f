#include "text.hpp"

#include <algorithm>

namespace goshawk::map_server {
namespace {

constexpr std::string_view kBlanks = " \t\r\n\v\f";

}  // namespace

std::string lower_case_ending(const std::string& path) {
  const std::size_t dot = path.find_last_of("./");
  if (dot == std::string::npos || path[dot] != '.') return {};
  std::string ending = path.substr(dot + 1);
  std::transform(ending.begin(), ending.end(), ending.begin(),
                 [](char c) { return c >= 'A' && c <= 'Z' ? char(c - 'A' + 'a') : c; });
  return ending;
}

std::string_view without_byte_order_mark(std::string_view text) {
  if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);
  return text;
}

TextReader::TextReader(std::string_view text) : rest_(text), end_('\n') {
  const std::size_t end = text.find_first_of("\r\n");
  if (end == std::string_view::npos || text[end] == '\n') return;
  if (end + 1 == text.size() || text[end + 1] != '\n') end_ = '\r';
}

std::string_view TextReader::line() {
  const std::size_t end = rest_.find(end_);
  std::string_view line = rest_.substr(0, end);
  rest_.remove_prefix(end == std::string_view::npos ? rest_.size() : end + 1);
  if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
  return line;
}

std::string_view TextReader::word() {
  rest_.remove_prefix(std::min(rest_.find_first_not_of(kBlanks), rest_.size()));
  const std::string_view word = rest_.substr(0, rest_.find_first_of(kBlanks));
  rest_.remove_prefix(word.size());
  return word;
}

std::vector<std::string_view> split(std::string_view line) {
  std::vector<std::string_view> words;
  TextReader reader(line);
  for (std::string_view word = reader.word(); !word.empty(); word = reader.word()) {
    words.push_back(word);
  }
  return words;
}

}  // namespace goshawk::map_server
