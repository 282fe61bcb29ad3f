#include "goshawk/introspection/meters.hpp"

#include <fmt/format.h>

#include <cstring>

#include "goshawk/introspection/schema.hpp"

namespace goshawk::introspection {
namespace {

// The header is the first field, and its stamp the first of the header: 4 + 4 bytes behind the
// encapsulation.
std::optional<double> stamp_s(const std::vector<unsigned char>& bytes) {
  if (bytes.size() < 12 || bytes[1] > 1) return std::nullopt;
  std::uint32_t words[2];
  std::memcpy(words, bytes.data() + 4, sizeof words);
  if (bytes[1] == 0) {
    for (auto& word : words) word = __builtin_bswap32(word);
  }
  return double(std::int32_t(words[0])) + double(words[1]) * 1e-9;
}

}  // namespace

void RateMeter::add(const RawMessage& message) {
  if (last_ns_) periods_s.add(double(message.received_ns - *last_ns_) * 1e-9);
  last_ns_ = message.received_ns;
}

std::optional<double> RateMeter::rate_hz() const {
  if (periods_s.empty() || !(periods_s.mean() > 0.0)) return std::nullopt;
  return 1.0 / periods_s.mean();
}

Status DelayMeter::check(const std::string& name) {
  auto type = find_type(name);
  if (!type) return fail(ErrorCode::invalid_parameter, type.error().message);
  const Field& first = (*type)->fields.front();
  if (first.kind == Kind::structure && first.arity == Arity::single &&
      all_types()[std::size_t(first.type)].name == "std_msgs/msg/Header") {
    return success();
  }
  return fail(ErrorCode::invalid_parameter,
              fmt::format("{} has no header, so no stamp to measure from; hz works", name));
}

void DelayMeter::add(const RawMessage& message) {
  if (const auto stamp = stamp_s(message.bytes)) {
    delays_s.add(double(message.received_ns) * 1e-9 - *stamp);
  }
}

void BandwidthMeter::add(const RawMessage& message) {
  sizes_byte.add(double(message.bytes.size()));
  times_s_.add(double(message.received_ns) * 1e-9);
}

double BandwidthMeter::bytes_per_s() const {
  // n messages span n - 1 periods.
  const double span_s = times_s_.empty() ? 0.0 : times_s_.back() - times_s_.front();
  return span_s > 0.0 ? (sizes_byte.sum() - sizes_byte.front()) / span_s : 0.0;
}

}  // namespace goshawk::introspection
