// Any bytes as a voxel grid and an update of it, first as a message of any content, then as CDR
// from the wire: refused, or a grid that holds together.
#include <fastcdr/Cdr.h>
#include <fastcdr/FastBuffer.h>
#include <fastcdr/exceptions/Exception.h>

#include <cstring>
#include <vector>

#include "goshawk/conversions/grid.hpp"

namespace {

using namespace goshawk;

template <typename Number>
Number take(const std::uint8_t*& at, std::size_t& left) {
  Number value{};
  const std::size_t n = std::min(sizeof value, left);
  std::memcpy(&value, at, n);
  at += n;
  left -= n;
  return value;
}

void expect(bool holds) {
  if (!holds) __builtin_trap();
}

void check(const goshawk_msgs::msg::VoxelGrid& m, const goshawk_msgs::msg::VoxelGridUpdate& u) {
  auto grid = conversions::from_msg(m);
  if (!grid) return expect(!grid.error().message.empty());
  expect(grid->check().ok());
  expect(grid->grown.count() <= grid->grown.voxels());
  goshawk_msgs::msg::VoxelGrid again;
  again.header(m.header());
  conversions::fill_msg(*grid, again);
  const auto twice = conversions::from_msg(again);
  expect(twice.ok() && twice->grown == grid->grown && twice->known == grid->known &&
         twice->raw == grid->raw);
  const auto update = conversions::from_msg(u);
  if (update && apply(*grid, *update)) expect(grid->check().ok());
}

goshawk_msgs::msg::VoxelGrid make_grid(const std::uint8_t*& at, std::size_t& left) {
  goshawk_msgs::msg::VoxelGrid m;
  const auto kind = take<std::uint8_t>(at, left);
  m.header().frame_id((kind & 1U) != 0 ? "map" : "odom");
  const auto edge = [&] {
    return (kind & 2U) != 0 ? take<std::uint32_t>(at, left) : take<std::uint8_t>(at, left);
  };
  m.size_x(edge());
  m.size_y(edge());
  m.size_z(edge());
  m.resolution((kind & 4U) != 0 ? take<double>(at, left) : 0.2);
  m.origin().x(take<float>(at, left));
  // Mostly as many words as the size asks for.
  const std::uint64_t rows = std::uint64_t{m.size_y()} * m.size_z();
  const std::uint64_t words = (std::uint64_t{m.size_x()} + 63) / 64 * rows + kind / 64 % 2;
  m.grown().resize(std::size_t(words < 4096 ? words : 7), take<std::uint64_t>(at, left));
  if ((kind & 8U) != 0) m.known().resize(m.grown().size() + kind / 128, ~std::uint64_t{0});
  if ((kind & 16U) != 0) m.raw().resize(m.grown().size(), take<std::uint64_t>(at, left));
  return m;
}

goshawk_msgs::msg::VoxelGridUpdate make_update(const std::uint8_t*& at, std::size_t& left) {
  goshawk_msgs::msg::VoxelGridUpdate u;
  u.header().frame_id("map");
  u.to_version(1);
  u.shift_word_x(take<std::int8_t>(at, left) % 3);
  u.shift_brick_y(take<std::int32_t>(at, left));
  u.shift_brick_z(take<std::int8_t>(at, left) % 3);
  u.bricks().resize(take<std::uint8_t>(at, left) % 4);
  for (auto& brick : u.bricks()) {
    brick.word_x(take<std::uint8_t>(at, left) % 3);
    brick.brick_y(take<std::uint32_t>(at, left));
    brick.brick_z(take<std::uint8_t>(at, left) % 3);
    brick.grown().resize(take<std::uint8_t>(at, left) < 250 ? 64 : 63, ~std::uint64_t{0});
    brick.known().resize(64, 5);
    if (take<std::uint8_t>(at, left) < 100) brick.raw().resize(64, 9);
  }
  return u;
}

template <typename Message>
bool read(Message& m, const std::uint8_t* data, std::size_t size) {
  std::vector<char> bytes(data, data + size);
  eprosima::fastcdr::FastBuffer buffer(bytes.data(), bytes.size());
  eprosima::fastcdr::Cdr cdr(buffer, eprosima::fastcdr::Cdr::DEFAULT_ENDIAN,
                             eprosima::fastcdr::Cdr::DDS_CDR);
  try {
    cdr.read_encapsulation();
    m.deserialize(cdr);
    return true;
  } catch (const eprosima::fastcdr::exception::Exception&) {
    return false;
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::uint8_t* at = data;
  std::size_t left = size;
  const auto grid = make_grid(at, left);
  check(grid, make_update(at, left));
  goshawk_msgs::msg::VoxelGrid wire;
  goshawk_msgs::msg::VoxelGridUpdate update;
  if (read(wire, data, size)) check(wire, {});
  if (read(update, data, size)) (void)conversions::from_msg(update);
  return 0;
}
