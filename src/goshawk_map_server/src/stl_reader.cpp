// STL (3D Systems, "StereoLithography Interface Specification", 1989): triangles, each with corners
// of its own; as text, or in binary.

#include <fmt/format.h>

#include <bit>
#include <cstring>

#include "readers.hpp"
#include "text.hpp"

namespace goshawk::map_server {
namespace {

constexpr std::size_t kHead = 84;      // [byte] a title, and the number of triangles
constexpr std::size_t kTriangle = 50;  // [byte] a normal, three corners and two bytes more

static_assert(std::endian::native == std::endian::little, "binary STL is little-endian");

std::uint32_t claimed_triangles(std::string_view bytes) {
  std::uint32_t count = 0;
  std::memcpy(&count, bytes.data() + kHead - sizeof count, sizeof count);
  return count;
}

void add_triangle_of_last_points(Cloud& cloud) {
  const auto n = std::uint32_t(cloud.points.size());
  cloud.triangles.push_back({n - 3, n - 2, n - 1});
}

Result<Cloud> read_binary(std::string_view bytes) {
  const std::uint32_t count = claimed_triangles(bytes);
  if ((bytes.size() - kHead) / kTriangle < count) {
    return malformed(
        fmt::format("the header promises {} triangles, the file has room for {}: it is "
                    "truncated, or no STL file",
                    count, (bytes.size() - kHead) / kTriangle));
  }
  Cloud cloud;
  cloud.single_precision = true;
  cloud.points.reserve(std::size_t{3} * count);
  cloud.triangles.reserve(count);
  for (std::uint32_t i = 0; i < count; ++i) {
    std::array<float, 9> v{};
    constexpr std::size_t kNormal = 12;  // [byte]
    std::memcpy(v.data(), bytes.data() + kHead + kTriangle * i + kNormal, sizeof v);
    for (std::size_t k = 0; k < 9; k += 3) cloud.points.emplace_back(v[k], v[k + 1], v[k + 2]);
    add_triangle_of_last_points(cloud);
  }
  return cloud;
}

Result<Cloud> read_text(std::string_view bytes) {
  TextReader reader(bytes);
  Cloud cloud;
  std::size_t corners = 0;  // of this triangle, so far
  bool ended = false;
  for (std::size_t number = 1; !reader.done(); ++number) {
    const auto words = split(reader.line());
    if (words.empty()) continue;
    ended = words[0] == "endsolid";
    if (words[0] == "endloop") {
      if (corners != 3) {
        return malformed(
            fmt::format("the facet that ends in line {} has {} corners, not 3", number, corners));
      }
      add_triangle_of_last_points(cloud);
      corners = 0;
    } else if (words[0] == "vertex") {
      std::array<std::optional<double>, 3> v;
      for (std::size_t k = 0; k < 3 && words.size() == 4; ++k) v[k] = parse<double>(words[k + 1]);
      if (!v[0] || !v[1] || !v[2]) {
        return malformed(fmt::format("line {} is not 'vertex X Y Z' with three numbers", number));
      }
      cloud.points.emplace_back(*v[0], *v[1], *v[2]);
      ++corners;
    }
  }
  if (!ended) return malformed("it does not end with 'endsolid': the file is truncated");
  return cloud;
}

}  // namespace

Result<Cloud> read_stl(std::string_view bytes) {
  // Some programs begin binary files with "solid", too: then their length tells.
  const bool fits = bytes.size() >= kHead &&
                    bytes.size() == kHead + kTriangle * std::size_t{claimed_triangles(bytes)};
  if (!fits && without_byte_order_mark(bytes).starts_with("solid")) {
    return read_text(without_byte_order_mark(bytes));
  }
  if (bytes.size() < kHead) return malformed("it is shorter than the header of an STL file");
  return read_binary(bytes);
}

}  // namespace goshawk::map_server
