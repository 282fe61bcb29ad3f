#pragma once

#include <limits>
#include <nlohmann/json.hpp>

#include "goshawk/core/random.hpp"
#include "goshawk/introspection/schema.hpp"

namespace goshawk::introspection {

/// Random content of a type as JSON: extreme numbers, empty and longer lists, odd characters.
class RandomMessage {
 public:
  using Json = nlohmann::ordered_json;
  explicit RandomMessage(std::uint64_t seed) : random_(seed) {}

  Json of(const Type& type) {
    Json json = Json::object();
    for (const auto& field : type.fields) json[std::string(field.name)] = of(field);
    return json;
  }

 private:
  Json of(const Field& field) {
    if (field.arity == Arity::single) return one(field);
    Json list = Json::array();
    const int count = field.arity == Arity::array ? int(field.size) : random_.below(5);
    for (int i = 0; i < count; ++i) list.push_back(one(field));
    return list;
  }

  Json one(const Field& field) {
    switch (field.kind) {
      case Kind::boolean:
        return random_.chance(0.5);
      case Kind::int8:
        return integer<std::int8_t>();
      case Kind::uint8:
        return integer<std::uint8_t>();
      case Kind::int16:
        return integer<std::int16_t>();
      case Kind::uint16:
        return integer<std::uint16_t>();
      case Kind::int32:
        return integer<std::int32_t>();
      case Kind::uint32:
        return integer<std::uint32_t>();
      case Kind::int64:
        return integer<std::int64_t>();
      case Kind::uint64:
        return integer<std::uint64_t>();
      case Kind::float32:
        return real<float>();
      case Kind::float64:
        return real<double>();
      case Kind::string:
        return text();
      case Kind::structure:
        return of(all_types()[std::size_t(field.type)]);
    }
    return nullptr;
  }

  template <typename T>
  Json integer() {
    switch (random_.below(4)) {
      case 0:
        return std::numeric_limits<T>::min();
      case 1:
        return std::numeric_limits<T>::max();
      default:
        return T(random_.next());
    }
  }

  template <typename T>
  Json real() {
    switch (random_.below(8)) {
      case 0:
        return "nan";
      case 1:
        return "inf";
      case 2:
        return "-inf";
      case 3:
        return -0.0;
      case 4:
        return double(std::numeric_limits<T>::denorm_min());
      case 5:
        return double(std::numeric_limits<T>::max());
      default:
        return double(T(random_.uniform(-1e6, 1e6)));
    }
  }

  std::string text() {
    static constexpr const char* kPieces[] = {"map", "", "\xc3\xa4", "\"\\", "\n\t", "base_link"};
    std::string all;
    for (int n = random_.below(4); n > 0; --n) all += kPieces[random_.below(6)];
    return all;
  }

  Random random_;
};

}  // namespace goshawk::introspection
