#pragma once

#include <yaml-cpp/yaml.h>

#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "goshawk/core/vector.hpp"

namespace goshawk::movers {

/// What is wrong with a text. Thrown by the parsers; no caller of the library sees it.
struct LineFault {
  int line = 0;  // from 1; 0: the text as a whole
  std::string message;
};

/// A YAML map whose keys are known. All calls throw LineFault with the line and the reason.
class YamlKeys {
 public:
  /// @param what it is, for sentences: "a mover"
  YamlKeys(const YAML::Node& map, std::string what, std::initializer_list<std::string_view> keys);

  int line() const { return line_; }
  bool has(std::string_view key) const;
  YAML::Node at(std::string_view key) const;

  double number(std::string_view key) const;
  double number(std::string_view key, double otherwise) const;
  int integer(std::string_view key, int lo, int hi) const;
  bool flag(std::string_view key, bool otherwise) const;
  std::string word(std::string_view key) const;
  std::vector<double> numbers(std::string_view key) const;
  Vec3 vector(std::string_view key) const;
  std::vector<Vec3> vectors(std::string_view key) const;

 private:
  YAML::Node map_;
  std::string what_;
  int line_;
};

/// @param what it is, for sentences @throws LineFault unless the text is one finite number
double number_of(const std::string& text, std::string_view what, int line);

}  // namespace goshawk::movers
