#pragma once

#include <cstdint>
#include <span>
#include <string_view>

/// What the messages of idl/ are made of, as idl_to_schema.py --layout writes it.
namespace goshawk::runtime::layout {

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

struct Field {
  std::string_view name;
  Kind kind;
  Arity arity;
  std::uint32_t size;  // elements of an array, else 1
  int type;            // of a structure: index into types(), else -1
};

struct Type {
  std::string_view name;  // on the wire
  std::span<const Field> fields;
  std::uint32_t least_size;  // [byte] no value of this type is shorter in CDR
};

/// Every struct of idl/, inner ones before those that hold them.
std::span<const Type> types();

}  // namespace goshawk::runtime::layout
