// The PLY format (Turk, "The PLY Polygon File Format", 1994).

#include <bit>
#include <cstdint>
#include <cstring>
#include <optional>
#include <string>

#include "readers.hpp"
#include "text.hpp"

namespace goshawk::map_server {
namespace {

enum class Type { i8, u8, i16, u16, i32, u32, f32, f64 };
enum class Encoding { ascii, little, big };

struct Property {
  std::string_view name;
  Type type = Type::f32;
  std::optional<Type> list_size;  // a list: its length comes first
};

struct Element {
  std::string_view name;
  std::uint64_t rows = 0;
  std::vector<Property> properties;
};

struct PlyHeader {
  Encoding encoding = Encoding::ascii;
  std::vector<Element> elements;
  std::string_view data;
};

std::optional<Type> type_of(std::string_view name) {
  if (name == "char" || name == "int8") return Type::i8;
  if (name == "uchar" || name == "uint8") return Type::u8;
  if (name == "short" || name == "int16") return Type::i16;
  if (name == "ushort" || name == "uint16") return Type::u16;
  if (name == "int" || name == "int32") return Type::i32;
  if (name == "uint" || name == "uint32") return Type::u32;
  if (name == "float" || name == "float32") return Type::f32;
  if (name == "double" || name == "float64") return Type::f64;
  return {};
}

std::size_t bytes_of(Type type) {
  constexpr std::size_t sizes[] = {1, 1, 2, 2, 4, 4, 4, 8};
  return sizes[std::size_t(type)];
}

bool is_integer(Type type) {
  return type != Type::f32 && type != Type::f64;
}

std::optional<Property> read_property(const std::vector<std::string_view>& words) {
  Property property;
  if (words.size() == 5 && words[1] == "list") {
    property.list_size = type_of(words[2]);
    if (!property.list_size || !is_integer(*property.list_size)) return {};
  } else if (words.size() != 3) {
    return {};
  }
  const auto type = type_of(words[words.size() - 2]);
  if (!type) return {};
  property.type = *type;
  property.name = words.back();
  return property;
}

Result<PlyHeader> read_ply_header(std::string_view bytes) {
  TextReader reader(bytes);
  if (reader.line() != "ply") return malformed("the first line is not 'ply': it is no PLY file");
  PlyHeader header;
  bool has_format = false;
  while (!reader.done()) {
    const auto words = split(reader.line());
    if (words.empty() || words[0] == "comment" || words[0] == "obj_info") continue;
    if (words[0] == "end_header") {
      header.data = reader.rest();
      if (!has_format) return malformed("the header tells no format");
      return header;
    }
    if (words[0] == "format" && words.size() >= 2) {
      has_format = true;
      if (words[1] == "ascii")
        header.encoding = Encoding::ascii;
      else if (words[1] == "binary_little_endian")
        header.encoding = Encoding::little;
      else if (words[1] == "binary_big_endian")
        header.encoding = Encoding::big;
      else
        return malformed("the format is none of ascii and binary of either endian");
    } else if (words[0] == "element" && words.size() == 3) {
      const auto rows = parse<std::uint64_t>(words[2]);
      if (!rows) return malformed("an element's number is no number");
      header.elements.push_back({words[1], *rows, {}});
    } else if (words[0] == "property" && !header.elements.empty()) {
      const auto property = read_property(words);
      if (!property) return malformed("a property in the header is not to be understood");
      header.elements.back().properties.push_back(*property);
    } else {
      return malformed("the header has a line that no PLY file has");
    }
  }
  return malformed("the header does not end: the file is truncated");
}

// Takes values off the front of the data, in any of the three encodings.
class Values {
 public:
  Values(std::string_view data, Encoding encoding)
      : text_(data), bytes_(data), encoding_(encoding) {}

  std::optional<double> next(Type type) {
    return encoding_ == Encoding::ascii ? parse<double>(text_.word()) : binary(type);
  }

 private:
  std::optional<double> binary(Type type) {
    const std::size_t size = bytes_of(type);
    if (bytes_.size() < size) return {};
    std::uint64_t bits = 0;
    for (std::size_t i = 0; i < size; ++i) {
      const std::size_t at = encoding_ == Encoding::big ? i : size - 1 - i;
      bits = bits << 8 | std::uint8_t(bytes_[at]);
    }
    bytes_.remove_prefix(size);
    switch (type) {
      case Type::i8:
        return double(std::int8_t(bits));
      case Type::i16:
        return double(std::int16_t(bits));
      case Type::i32:
        return double(std::int32_t(bits));
      case Type::f32:
        return double(std::bit_cast<float>(std::uint32_t(bits)));
      case Type::f64:
        return std::bit_cast<double>(bits);
      default:
        return double(bits);
    }
  }

  TextReader text_;
  std::string_view bytes_;
  Encoding encoding_;
};

// Takes one row off; gives x, y, z where the row has them. Each value takes at least a byte, so
// the file's length bounds the work whatever a list claims.
bool read_row(Values& values, const Element& element, Vec3& p) {
  for (const Property& property : element.properties) {
    double length = 1.0;
    if (property.list_size) {
      const auto claimed = values.next(*property.list_size);
      if (!claimed || !(*claimed >= 0.0)) return false;
      length = *claimed;
    }
    for (double i = 0.0; i < length; i += 1.0) {
      const auto value = values.next(property.type);
      if (!value) return false;
      if (property.list_size) continue;
      if (property.name == "x") p.x() = *value;
      if (property.name == "y") p.y() = *value;
      if (property.name == "z") p.z() = *value;
    }
  }
  return true;
}

bool has_xyz(const Element& element) {
  int found = 0;
  for (const Property& property : element.properties) {
    const bool coordinate = property.name == "x" || property.name == "y" || property.name == "z";
    if (coordinate && !property.list_size && !is_integer(property.type)) ++found;
  }
  return found == 3;
}

}  // namespace

Result<Points> read_ply(std::string_view bytes) {
  const auto header = read_ply_header(bytes);
  if (!header) return header.error();
  Values values(header->data, header->encoding);
  for (const Element& element : header->elements) {
    const bool vertices = element.name == "vertex";
    if (vertices && !has_xyz(element)) {
      return malformed("the element vertex lacks float properties x, y, z");
    }
    if (element.properties.empty()) continue;
    Points points;
    for (std::uint64_t row = 0; row < element.rows; ++row) {
      Vec3 p = Vec3::Zero();
      if (!read_row(values, element, p)) {
        return malformed("the header promises " + std::to_string(element.rows) + " rows of '" +
                         std::string(element.name) + "', but row " + std::to_string(row + 1) +
                         " is cut off or no number: the file is truncated or damaged");
      }
      if (vertices) points.push_back(p);
    }
    if (vertices) return points;
  }
  return malformed("it has no element 'vertex'");
}

}  // namespace goshawk::map_server
