#include "ros_entities.hpp"

#include <algorithm>
#include <cstdint>

#include "goshawk/runtime/ros_args.hpp"

namespace goshawk::runtime {
namespace {

constexpr std::size_t kGidsFrom = 4;          // [byte] before what is aligned
constexpr std::size_t kLongestRosName = 256;  // [byte] ROS' bound
constexpr std::size_t kRosPadding = 3;        // [byte] behind a message

/// Appends to a message in XCDR1, little endian.
class EntitiesOutput {
 public:
  explicit EntitiesOutput(GidLength length) : gid_bytes_(std::size_t(length)) {}

  void count(std::size_t value) {
    while (bytes_.size() % 4 != 0) bytes_.push_back(0);
    for (int shift = 0; shift < 32; shift += 8) {
      bytes_.push_back(static_cast<unsigned char>(value >> shift));
    }
  }
  void text(const std::string& value) {
    count(value.size() + 1);
    bytes_.insert(bytes_.end(), value.begin(), value.end());
    bytes_.push_back(0);
  }
  void gid(const Gid& value) {
    bytes_.insert(bytes_.end(), value.begin(), value.end());
    bytes_.resize(bytes_.size() + gid_bytes_ - value.size());
  }
  void gids(const std::vector<Gid>& values) {
    count(values.size());
    for (const auto& value : values) gid(value);
  }
  std::vector<unsigned char> take() { return std::move(bytes_); }

 private:
  std::size_t gid_bytes_;
  std::vector<unsigned char> bytes_{0, 1, 0, 0};
};

/// Reads a message; once something does not fit, is_good() is false and all else is empty.
class EntitiesInput {
 public:
  EntitiesInput(std::span<const unsigned char> payload, GidLength length)
      : bytes_(payload), gid_bytes_(std::size_t(length)) {
    is_good_ = payload.size() >= kGidsFrom && payload[0] == 0 && payload[1] <= 1;
    is_little_ = is_good_ && payload[1] == 1;
  }

  std::size_t count() {
    at_ = (at_ + 3) / 4 * 4;
    const auto four = take(4);
    std::uint32_t value = 0;
    for (std::size_t i = 0; i < four.size(); ++i) {
      value = value << 8 | four[is_little_ ? four.size() - 1 - i : i];
    }
    return value;
  }
  std::string text() {
    const std::size_t size = count();
    is_good_ = is_good_ && size >= 1 && size <= kLongestRosName + 1;
    const auto part = take(size);
    is_good_ = is_good_ && part.back() == 0;
    return is_good_ ? std::string(part.begin(), part.end() - 1) : std::string();
  }
  Gid gid() {
    const auto part = take(gid_bytes_);
    Gid value{};
    if (!is_good_) return value;
    std::ranges::copy(part.first(value.size()), value.begin());
    is_good_ = std::ranges::all_of(part.subspan(value.size()), [](auto b) { return b == 0; });
    return value;
  }
  void skip_gids() {
    const std::size_t size = count();
    for (std::size_t i = 0; i < size && is_good_; ++i) gid();
  }
  bool is_good() const { return is_good_; }
  bool is_whole() const { return is_good_ && bytes_.size() - at_ <= kRosPadding; }

 private:
  std::span<const unsigned char> take(std::size_t size) {
    is_good_ = is_good_ && at_ <= bytes_.size() && size <= bytes_.size() - at_;
    if (!is_good_) return {};
    at_ += size;
    return bytes_.subspan(at_ - size, size);
  }

  std::span<const unsigned char> bytes_;
  std::size_t gid_bytes_;
  std::size_t at_ = kGidsFrom;  // alignment counts from there, and it is a multiple of 4
  bool is_good_ = false;
  bool is_little_ = false;
};

std::optional<RosNodeNames> decode_as(std::span<const unsigned char> payload, GidLength length) {
  EntitiesInput in(payload, length);
  RosNodeNames entities{in.gid()};
  const std::size_t nodes = in.count();
  for (std::size_t i = 0; i < nodes && in.is_good(); ++i) {
    const std::string space = in.text();
    const std::string full = (space == "/" ? "" : space) + "/" + in.text();
    in.skip_gids();
    in.skip_gids();
    if (!in.is_good() || !full.starts_with('/') || !check_topic_name(full)) return std::nullopt;
    entities.names.push_back(full);
  }
  if (!in.is_whole()) return std::nullopt;
  return entities;
}

}  // namespace

std::vector<unsigned char> encode(const RosEntities& entities, GidLength length) {
  EntitiesOutput out(length);
  out.gid(entities.participant);
  out.count(entities.nodes.size());
  for (const auto& node : entities.nodes) {
    const auto slash = node.full_name.rfind('/');
    out.text(slash == 0 ? "/" : node.full_name.substr(0, slash));
    out.text(node.full_name.substr(slash + 1));
    out.gids(node.readers);
    out.gids(node.writers);
  }
  return out.take();
}

std::optional<RosNodeNames> decode_node_names(std::span<const unsigned char> payload) {
  // A shorter form read as the longer one has a count where zeros must be.
  auto entities = decode_as(payload, GidLength::humble);
  return entities ? entities : decode_as(payload, GidLength::iron);
}

}  // namespace goshawk::runtime
