#include "goshawk/introspection/field_path.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <optional>

#include "goshawk/runtime/parameters.hpp"

namespace goshawk::introspection {
namespace {

using Json = nlohmann::ordered_json;

// "polytopes[2]" is a name and an index.
struct Word {
  std::string_view name;
  std::optional<int> index;
};

Result<Word> parse_word(std::string_view text) {
  const std::size_t bracket = text.find('[');
  Word word{text.substr(0, bracket), {}};
  if (bracket == std::string_view::npos) return word;
  const std::string_view digits = text.substr(bracket + 1);
  int index = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), index);
  if (error != std::errc{} || std::string_view(end, digits.data() + digits.size()) != "]") {
    return fail(ErrorCode::invalid_parameter,
                fmt::format("'{}' is not a field, nor an element like {}[0]", text, word.name));
  }
  word.index = index;
  return word;
}

Result<const Field*> field_of(const Type& type, std::string_view name) {
  const auto found = std::ranges::find(type.fields, name, &Field::name);
  if (found != type.fields.end()) return &*found;
  std::vector<std::string> names;
  for (const Field& field : type.fields) names.emplace_back(field.name);
  const std::string near = runtime::nearest_name(std::string(name), names);
  return fail(
      ErrorCode::invalid_parameter,
      fmt::format("{} has no field '{}'{} (goshawk interface show {} lists them)", type.name, name,
                  near.empty() ? "" : fmt::format("; did you mean {}?", near), type.name));
}

void add_values(const Json& json, bool& first, std::string& out) {
  if (json.is_structured()) {
    for (const auto& value : json) add_values(value, first, out);
    return;
  }
  if (!first) out += ',';
  first = false;
  if (!json.is_string()) {
    out += json.dump();
    return;
  }
  const std::string text = json.get<std::string>();
  if (text.find_first_of(",\"\r\n") == std::string::npos) {
    out += text;
    return;
  }
  out += '"';
  for (const char c : text) out += c == '"' ? std::string("\"\"") : std::string(1, c);
  out += '"';
}

}  // namespace

Result<FieldPath> FieldPath::parse(const Type& type, std::string_view text) {
  FieldPath path;
  path.type_ = &type;
  for (bool more = !text.empty(); more;) {
    const std::size_t dot = text.find('.');
    const auto word = parse_word(text.substr(0, dot));
    if (!word) return word.error();
    if (path.type_ == nullptr) {
      return fail(
          ErrorCode::invalid_parameter,
          fmt::format("there is no field '{}' below a value or a list; an element of a list "
                      "is named as in points[0]",
                      word->name));
    }
    const auto field = field_of(*path.type_, word->name);
    if (!field) return field.error();
    const bool list = (*field)->arity != Arity::single;
    if (word->index && !list) {
      return fail(ErrorCode::invalid_parameter, fmt::format("'{}' is not a list", word->name));
    }
    path.steps_.emplace_back(std::string(word->name));
    if (word->index) path.steps_.emplace_back(*word->index);
    const bool structure = (*field)->type >= 0 && (!list || word->index);
    path.type_ = structure ? &all_types()[std::size_t((*field)->type)] : nullptr;
    more = dot != std::string_view::npos;
    if (more) text.remove_prefix(dot + 1);
  }
  return path;
}

const Json* FieldPath::find(const Json& message) const {
  const Json* at = &message;
  for (const auto& step : steps_) {
    if (const auto* name = std::get_if<std::string>(&step)) {
      at = &at->at(*name);
      continue;
    }
    const auto size = std::int64_t(at->size());
    const std::int64_t index = std::get<int>(step);
    const std::int64_t element = index < 0 ? size + index : index;
    if (element < 0 || element >= size) return nullptr;
    at = &(*at)[std::size_t(element)];
  }
  return at;
}

std::string to_csv(const Json& json) {
  std::string out;
  bool first = true;
  add_values(json, first, out);
  return out;
}

}  // namespace goshawk::introspection
