#pragma once

#include <nlohmann/json_fwd.hpp>
#include <span>
#include <vector>

#include "goshawk/introspection/schema.hpp"

namespace goshawk::introspection {

/// A message in XCDR1 as it is on the wire (4 bytes of encapsulation in front, either byte order)
/// as JSON: structs are objects in the order of their fields, sequences and arrays are arrays.
/// Numbers keep every bit; values that JSON cannot write are the strings "nan", "inf" and "-inf".
///
/// The bytes are not trusted: a length that they cannot hold, a bool that is neither 0 nor 1 and a
/// wrong encapsulation are errors, found before any memory is allocated for them.
/// @return invalid_input that names field and fault
Result<nlohmann::ordered_json> cdr_to_json(const Type& type, std::span<const unsigned char> bytes);

/// The way back, little-endian. Fields that the JSON leaves out are zero, empty or false. A field
/// with constants also takes the name of one: {"verb": "VERB_SET"}.
/// @return invalid_input that names the field: unknown (and the nearest known one), of another
/// type, out of range, or of the wrong number of elements
Result<std::vector<unsigned char>> json_to_cdr(const Type& type,
                                               const nlohmann::ordered_json& json);

}  // namespace goshawk::introspection
