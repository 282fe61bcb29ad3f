// Anything that a client may send, message by message (parted by a zero byte): it is answered, and
// what it may not do ends its session with a reason. A message that begins with 'b' is binary.
#include <cstdint>
#include <cstdlib>
#include <string>

#include "../src/session.hpp"
#include "goshawk/viewer_bridge/origins.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace goshawk::viewer_bridge;
  Session session(1);
  const std::string all(reinterpret_cast<const char*>(data), size);
  for (std::size_t at = 0; at < all.size() && !session.closed();) {
    const std::size_t end = std::min(all.find('\0', at), all.size());
    std::string message = all.substr(at, end - at);
    at = end + 1;
    const bool binary = message.starts_with('b');
    if (binary) message.erase(0, 1);
    const auto answer = binary ? session.on_binary(message)
                               : session.on_text(message, [](std::uint32_t id) { return id < 8; });
    if (!answer.close.empty()) session.set_closed();
    for (const auto& warning : answer.warnings) {
      if (warning.empty()) std::abort();
    }
  }
  if (const auto origins = Origins::parse(all)) (void)origins->allow("http://a.example");
  return 0;
}
