// Any bytes as a recording: an error, or messages in the order of their times; complaints are
// sentences.
#include <sys/mman.h>
#include <unistd.h>

#include <cstdint>
#include <cstdlib>
#include <string>

#include "goshawk/recording/reader.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace goshawk::recording;
  const int file = memfd_create("recording", 0);
  if (file < 0 || write(file, data, size) != ssize_t(size)) std::abort();
  const auto close_file = [file](int) {
    close(file);
    return 0;
  };
  auto reader = Reader::open("/proc/self/fd/" + std::to_string(file));
  if (!reader) {
    if (reader.error().message.empty()) std::abort();
    return close_file(0);
  }
  std::uint64_t last_ns = 0, many = 0;
  const auto status = reader->read({}, [&](const MessageView& message) {
    if (message.log_time_ns < last_ns) std::abort();
    last_ns = message.log_time_ns;
    return ++many < 10'000;
  });
  if (!status && status.error().message.empty()) std::abort();
  for (const auto& complaint : reader->complaints()) {
    if (complaint.empty()) std::abort();
  }
  return close_file(0);
}
