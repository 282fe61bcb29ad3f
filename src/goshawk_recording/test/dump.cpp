// recording_dump FILE.mcap: a line of JSON for each message, for the readers of others to compare.

#include <cstdio>
#include <nlohmann/json.hpp>

#include "goshawk/introspection/codec.hpp"
#include "goshawk/recording/reader.hpp"

using namespace goshawk;
using Json = nlohmann::ordered_json;

namespace {

// What others do not write as they read it: NaN has many bit patterns, and npm's ROS 2 writer
// counts the characters of a text instead of its bytes.
bool is_lossy(const Json& value) {
  if (value.is_string()) {
    const auto& text = value.get_ref<const std::string&>();
    return text == "nan" || std::any_of(text.begin(), text.end(), [](char c) { return c < 0; });
  }
  if (!value.is_structured()) return false;
  return std::any_of(value.begin(), value.end(), is_lossy);
}

std::string hex(const std::vector<unsigned char>& bytes) {
  std::string text;
  for (const unsigned char byte : bytes) {
    text += "0123456789abcdef"[byte >> 4];
    text += "0123456789abcdef"[byte & 15];
  }
  return text;
}

int complain(const std::string& sentence) {
  std::fprintf(stderr, "%s\n", sentence.c_str());
  return 1;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) return complain("usage: recording_dump FILE.mcap");
  auto reader = recording::Reader::open(argv[1]);
  if (!reader) return complain(reader.error().message);
  std::string fault;
  const auto read = reader->read({}, [&](const recording::MessageView& m) {
    const auto& channel = reader->channels().at(m.channel_id);
    const auto type = introspection::find_type(reader->schema_of(channel)->name);
    const auto value =
        type ? introspection::cdr_to_json(**type, m.data) : Result<Json>(type.error());
    if (!value) {
      fault = value.error().message;
      return false;
    }
    const Json line = {{"topic", channel.topic},
                       {"type", (*type)->name},
                       {"sequence", m.sequence},
                       {"log_time_ns", std::to_string(m.log_time_ns)},
                       {"bytes", m.data.size()},
                       {"lossy", is_lossy(*value)},
                       {"again", hex(*introspection::json_to_cdr(**type, *value))},
                       {"value", *value}};
    std::printf("%s\n", line.dump(-1, ' ', false, Json::error_handler_t::replace).c_str());
    return true;
  });
  if (!fault.empty()) return complain(fault);
  return read ? 0 : complain(read.error().message);
}
