// recording_sample FILE.mcap: a recording with random content of every message type of idl/.

#include <cstdio>

#include "goshawk/introspection/codec.hpp"
#include "goshawk/recording/writer.hpp"
#include "qos_profiles.hpp"
#include "random_message.hpp"

using namespace goshawk;

namespace {

constexpr int kOfEach = 20;

std::map<const introspection::Type*, std::uint16_t> add_channels(recording::Writer& writer) {
  std::map<const introspection::Type*, std::uint16_t> channels;
  for (const auto& type : introspection::all_types()) {
    std::string topic = "/";
    for (const char c : type.name) topic += c == '/' ? '_' : c;
    runtime::EndpointInfo endpoint;
    endpoint.reliable = true;
    const auto schema = writer.add_schema(std::string(type.name), "ros2msg",
                                          introspection::ros_msg_definition(type));
    channels[&type] = writer.add_channel(
        {.schema_id = schema,
         .topic = topic,
         .message_encoding = "cdr",
         .metadata = {{recording::kQosKey, recording::to_profiles({endpoint})}}});
  }
  return channels;
}

}  // namespace

int main(int argc, char** argv) {
  auto sink = recording::create_file(argc == 2 ? argv[1] : "", true);
  recording::WriterOptions options;
  options.chunk_bytes = 20'000;
  auto writer = sink ? recording::Writer::create(*std::move(sink), options)
                     : Result<recording::Writer>(sink.error());
  if (!writer) {
    std::fprintf(stderr, "%s\n", writer.error().message.c_str());
    return 1;
  }
  const auto channels = add_channels(*writer);
  (void)writer->flush();  // channels before any message, as a recorder has them
  introspection::RandomMessage random(11);
  std::uint64_t time_ns = 1'700'000'000'000'000'000;
  for (int k = 0; k < kOfEach; ++k) {
    for (const auto& type : introspection::all_types()) {
      const auto bytes = introspection::json_to_cdr(type, random.of(type));
      if (!bytes) {
        std::fprintf(stderr, "%s\n", bytes.error().message.c_str());
        return 1;
      }
      time_ns += 1000;
      (void)writer->write({channels.at(&type), std::uint32_t(k), time_ns, time_ns, *bytes});
    }
  }
  return writer->close() ? 0 : 1;
}
