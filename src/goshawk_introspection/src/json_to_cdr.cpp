#include <fmt/format.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <nlohmann/json.hpp>

#include "goshawk/introspection/codec.hpp"
#include "goshawk/runtime/parameters.hpp"

namespace goshawk::introspection {
namespace {

using Json = nlohmann::ordered_json;

static_assert(std::endian::native == std::endian::little, "json_to_cdr writes the native order");

class Encoder {
 public:
  std::vector<unsigned char> take() { return std::move(bytes_); }
  Error error(const Type& type) const {
    return fail(ErrorCode::invalid_input, "this is not a valid " + std::string(type.name) + ": " +
                                              path_ + (path_.empty() ? "" : " ") + fault_);
  }

  // json == nullptr: left out, so everything inside is zero.
  bool write(const Type& type, const Json* json) {
    if (json != nullptr && !json->is_object()) return wrong(*json, "an object {field: value, ...}");
    if (json != nullptr && !only_known_fields(type, *json)) return false;
    for (const auto& field : type.fields) {
      const Json* value = nullptr;
      if (json != nullptr) {
        const auto found = json->find(std::string(field.name));
        if (found != json->end()) value = &*found;
      }
      if (!write(field, value)) {
        path_ = std::string(field.name) + (path_.empty() || path_[0] == '[' ? "" : ".") + path_;
        return false;
      }
    }
    return true;
  }

 private:
  bool only_known_fields(const Type& type, const Json& json) {
    std::vector<std::string> known;
    for (const auto& field : type.fields) known.emplace_back(field.name);
    for (const auto& [name, value] : json.items()) {
      if (std::find(known.begin(), known.end(), name) != known.end()) continue;
      const std::string near = runtime::nearest_name(name, known);
      std::string all;
      for (const auto& k : known) all += (all.empty() ? "" : ", ") + k;
      fault_ = fmt::format("'{}' is not a field of {}; {}", name, type.name,
                           near.empty() ? "its fields are " + all : "did you mean " + near + "?");
      return false;
    }
    return true;
  }

  bool write(const Field& field, const Json* json) {
    if (field.arity == Arity::single) return write_one(field, json);
    if (json != nullptr && !json->is_array()) return wrong(*json, "a list [value, ...]");
    std::size_t count = json == nullptr ? 0 : json->size();
    if (field.arity == Arity::sequence) {
      put(std::uint32_t(count));
    } else if (json == nullptr) {
      count = field.size;
    } else if (count != field.size) {
      fault_ = fmt::format("has {} elements: it must have {}", count, field.size);
      return false;
    }
    for (std::size_t i = 0; i < count; ++i) {
      if (!write_one(field, json == nullptr ? nullptr : &(*json)[i])) {
        path_ = fmt::format("[{}]{}{}", i, path_.empty() ? "" : ".", path_);
        return false;
      }
    }
    return true;
  }

  bool write_one(const Field& field, const Json* json) {
    switch (field.kind) {
      case Kind::boolean:
        return write_bool(json);
      case Kind::int8:
        return write_integer<std::int8_t>(json);
      case Kind::uint8:
        if (json != nullptr && json->is_string() && !field.constants.empty()) {
          return write_constant(field, *json);
        }
        return write_integer<std::uint8_t>(json);
      case Kind::int16:
        return write_integer<std::int16_t>(json);
      case Kind::uint16:
        return write_integer<std::uint16_t>(json);
      case Kind::int32:
        return write_integer<std::int32_t>(json);
      case Kind::uint32:
        return write_integer<std::uint32_t>(json);
      case Kind::int64:
        return write_integer<std::int64_t>(json);
      case Kind::uint64:
        return write_integer<std::uint64_t>(json);
      case Kind::float32:
        return write_float<float>(json);
      case Kind::float64:
        return write_float<double>(json);
      case Kind::string:
        return write_string(json);
      case Kind::structure:
        return write(all_types()[std::size_t(field.type)], json);
    }
    throw std::logic_error("json_to_cdr: unknown kind");
  }

  template <typename T>
  void put(T value) {
    while ((bytes_.size() - 4) % sizeof(T) != 0) bytes_.push_back(0);
    const auto* raw = reinterpret_cast<const unsigned char*>(&value);
    bytes_.insert(bytes_.end(), raw, raw + sizeof(T));
  }

  bool write_bool(const Json* json) {
    if (json != nullptr && !json->is_boolean()) return wrong(*json, "true or false");
    put(std::uint8_t(json != nullptr && json->get<bool>()));
    return true;
  }

  template <typename T>
  bool write_integer(const Json* json) {
    T value = 0;
    if (json != nullptr) {
      if (!json->is_number_integer()) return wrong(*json, "a whole number");
      const bool fits = json->is_number_unsigned() ? std::in_range<T>(json->get<std::uint64_t>())
                                                   : std::in_range<T>(json->get<std::int64_t>());
      if (!fits) {
        return wrong(*json, fmt::format("from {} to {}", std::numeric_limits<T>::min() + 0,
                                        std::numeric_limits<T>::max() + 0));
      }
      value = json->get<T>();
    }
    put(value);
    return true;
  }

  // The name of a constant instead of its value.
  bool write_constant(const Field& field, const Json& json) {
    const auto& name = json.get_ref<const std::string&>();
    std::string all;
    for (const auto& constant : field.constants) {
      if (constant.name == name) {
        put(std::uint8_t(constant.value));
        return true;
      }
      all += (all.empty() ? "" : ", ") + std::string(constant.name);
    }
    return wrong(json, "a number or one of " + all);
  }

  template <typename T>
  bool write_float(const Json* json) {
    double value = 0.0;
    if (json != nullptr) {
      if (json->is_number()) {
        value = json->get<double>();
        if (std::abs(value) > double(std::numeric_limits<T>::max())) {
          return wrong(*json, "a number that a float can hold");
        }
      } else if (*json == "nan") {
        value = std::numeric_limits<double>::quiet_NaN();
      } else if (*json == "inf" || *json == "-inf") {
        value = (*json == "inf" ? 1 : -1) * std::numeric_limits<double>::infinity();
      } else {
        return wrong(*json, "a number, \"nan\", \"inf\" or \"-inf\"");
      }
    }
    put(T(value));
    return true;
  }

  bool write_string(const Json* json) {
    static const std::string kEmpty;
    if (json != nullptr && !json->is_string()) return wrong(*json, "a string: quote it");
    const auto& text = json == nullptr ? kEmpty : json->get_ref<const std::string&>();
    if (text.find('\0') != std::string::npos) {
      fault_ = "contains a zero character, which ends a string on the wire";
      return false;
    }
    put(std::uint32_t(text.size() + 1));
    bytes_.insert(bytes_.end(), text.begin(), text.end());
    bytes_.push_back(0);
    return true;
  }

  bool wrong(const Json& json, const std::string& wanted) {
    std::string shown = json.dump(-1, ' ', false, Json::error_handler_t::replace);
    if (shown.size() > 40) shown = shown.substr(0, 40) + "...";
    fault_ = "is " + shown + ": it must be " + wanted;
    return false;
  }

  std::vector<unsigned char> bytes_ = {0, 1, 0, 0};  // plain CDR, little-endian
  std::string path_;                                 // to the field at fault, outermost first
  std::string fault_;
};

}  // namespace

Result<std::vector<unsigned char>> json_to_cdr(const Type& type, const Json& json) {
  Encoder encoder;
  if (!encoder.write(type, &json)) return encoder.error(type);
  return encoder.take();
}

}  // namespace goshawk::introspection
