#include "yaml_keys.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "goshawk/core/number.hpp"

namespace goshawk::movers {
namespace {

int line_of(const YAML::Node& node) {
  return node.Mark().line + 1;
}

double number_in(const YAML::Node& node, std::string_view what) {
  if (!node.IsScalar()) throw LineFault{line_of(node), fmt::format("{} is not a number", what)};
  return number_of(node.Scalar(), what, line_of(node));
}

Vec3 vector_in(const YAML::Node& node, std::string_view what) {
  if (!node.IsSequence() || node.size() != 3) {
    throw LineFault{line_of(node), fmt::format("{} is not three numbers: write [3, 8, 2]", what)};
  }
  Vec3 v;
  for (int axis = 0; axis < 3; ++axis) v[axis] = number_in(node[std::size_t(axis)], what);
  return v;
}

}  // namespace

double number_of(const std::string& text, std::string_view what, int line) {
  const auto value = finite_number(text);
  if (!value) {
    throw LineFault{line, text.empty() ? fmt::format("{} is empty", what)
                                       : fmt::format("{}: '{}' is not a number", what, text)};
  }
  return *value;
}

YamlKeys::YamlKeys(const YAML::Node& map, std::string what,
                   std::initializer_list<std::string_view> keys)
    : map_(map), what_(std::move(what)), line_(line_of(map)) {
  if (!map.IsMap()) {
    throw LineFault{
        line_, fmt::format("{} is not a map of keys: it has {}", what_, fmt::join(keys, ", "))};
  }
  std::vector<std::string> seen;
  for (const auto& entry : map) {
    const std::string key = entry.first.IsScalar() ? entry.first.Scalar() : "";
    if (std::ranges::find(keys, std::string_view(key)) == keys.end()) {
      throw LineFault{line_of(entry.first), fmt::format("{} has no key '{}': it has {}", what_, key,
                                                        fmt::join(keys, ", "))};
    }
    if (std::ranges::find(seen, key) != seen.end()) {
      throw LineFault{line_of(entry.first), fmt::format("{} is specified twice", key)};
    }
    seen.push_back(key);
  }
}

bool YamlKeys::has(std::string_view key) const {
  return bool(map_[std::string(key)]);
}

YAML::Node YamlKeys::at(std::string_view key) const {
  const YAML::Node node = map_[std::string(key)];
  if (!node) throw LineFault{line_, fmt::format("{} needs {}", what_, key)};
  return node;
}

double YamlKeys::number(std::string_view key) const {
  return number_in(at(key), key);
}

double YamlKeys::number(std::string_view key, double otherwise) const {
  return has(key) ? number(key) : otherwise;
}

int YamlKeys::integer(std::string_view key, int lo, int hi) const {
  const double value = number(key);
  if (value != std::floor(value) || value < lo || value > hi) {
    throw LineFault{line_of(at(key)),
                    fmt::format("{} is not a whole number from {} to {}", key, lo, hi)};
  }
  return int(value);
}

bool YamlKeys::flag(std::string_view key, bool otherwise) const {
  if (!has(key)) return otherwise;
  const std::string text = word(key);
  if (text == "true" || text == "false") return text == "true";
  throw LineFault{line_of(at(key)), fmt::format("{} is neither true nor false", key)};
}

std::string YamlKeys::word(std::string_view key) const {
  const YAML::Node node = at(key);
  if (!node.IsScalar()) throw LineFault{line_of(node), fmt::format("{} is not a word", key)};
  return node.Scalar();
}

std::vector<double> YamlKeys::numbers(std::string_view key) const {
  const YAML::Node node = at(key);
  if (!node.IsSequence()) {
    throw LineFault{line_of(node), fmt::format("{} is not a list of numbers", key)};
  }
  std::vector<double> found;
  for (const auto& entry : node) found.push_back(number_in(entry, key));
  return found;
}

Vec3 YamlKeys::vector(std::string_view key) const {
  return vector_in(at(key), key);
}

std::vector<Vec3> YamlKeys::vectors(std::string_view key) const {
  const YAML::Node node = at(key);
  if (!node.IsSequence()) {
    throw LineFault{line_of(node), fmt::format("{} is not a list of places", key)};
  }
  std::vector<Vec3> found;
  for (const auto& entry : node) found.push_back(vector_in(entry, key));
  return found;
}

}  // namespace goshawk::movers
