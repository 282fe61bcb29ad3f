#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

/// What the messages of idl/ are made of: idl_to_schema.py makes the table when this is built.
namespace goshawk::runtime::schema {

enum class Kind : std::uint8_t {
  boolean,
  int8,
  uint8,
  int16,
  uint16,
  int32,
  uint32,
  int64,
  uint64,
  float32,
  float64,
  string,
  structure
};

enum class Arity : std::uint8_t { single, array, sequence };

/// A value of a field that has a name: {"STATE_IDLE", 0}.
struct Constant {
  std::string_view name;
  std::uint64_t value;
};

struct Field {
  std::string_view name;
  Kind kind;
  Arity arity;
  std::uint32_t size;                   // elements of an array, else 1
  int type;                             // of a structure: index into types(), else -1
  std::string_view comment;             // unit and meaning, as in idl/
  std::span<const Constant> constants;  // names of its values, if it is an enumeration
};

struct Type {
  std::string_view name;  // "goshawk_msgs/msg/Path"
  std::string_view comment;
  std::span<const Field> fields;
  std::uint32_t least_size;  // [byte] no value of this type is shorter in CDR
};

/// Every struct of idl/, inner ones before those that hold them.
std::span<const Type> types();

/// @return [byte] alignment and size of a primitive in CDR; a string counts as its length field, a
/// structure as 0
constexpr std::uint32_t size_of(Kind kind) {
  constexpr std::uint32_t sizes[] = {1, 1, 1, 2, 2, 4, 4,
                                     8, 8, 4, 8, 4, 0};  // in the order of Kind
  return sizes[std::size_t(kind)];
}

}  // namespace goshawk::runtime::schema
