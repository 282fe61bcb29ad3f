// Wavefront OBJ (Wavefront Technologies, "Advanced Visualizer", appendix B1): the vertices, faces
// and lines of it; free-form curves and surfaces are refused.

#include <fmt/format.h>

#include <limits>

#include "readers.hpp"
#include "text.hpp"

namespace goshawk::map_server {
namespace {

using Words = std::vector<std::string_view>;

class ObjReader {
 public:
  explicit ObjReader(std::string_view bytes) : reader_(bytes) {}
  Result<Cloud> read();

 private:
  Status take(const Words& words);
  Status take_vertex(const Words& words);
  Status take_corners(const Words& words);
  Result<std::uint32_t> vertex_of(std::string_view word) const;
  Words next_line();
  Error in_line(const std::string& what) const {
    return malformed(fmt::format("line {} {}", line_, what));
  }

  TextReader reader_;
  Cloud cloud_;
  std::size_t line_ = 0;
};

Result<Cloud> ObjReader::read() {
  while (!reader_.done()) {
    const Words words = next_line();
    if (words.empty() || words[0].front() == '#') continue;
    if (auto status = take(words); !status) return status.error();
  }
  return std::move(cloud_);
}

// A line whose last word is a backslash goes on in the next one.
Words ObjReader::next_line() {
  Words words;
  do {
    if (!words.empty()) words.pop_back();
    ++line_;
    const Words more = split(reader_.line());
    words.insert(words.end(), more.begin(), more.end());
  } while (!words.empty() && words.back() == "\\" && !reader_.done());
  return words;
}

Status ObjReader::take(const Words& words) {
  if (words[0] == "v") return take_vertex(words);
  if (words[0] == "f" || words[0] == "l") return take_corners(words);
  for (const std::string_view free_form : {"curv", "surf", "cstype"}) {
    if (words[0] == free_form) {
      return in_line(
          fmt::format("has '{}', a free-form surface: export the mesh as triangles", words[0]));
    }
  }
  return success();  // points, names, normals, textures and materials
}

// "v X Y Z", and a weight or a colour behind it.
Status ObjReader::take_vertex(const Words& words) {
  std::array<std::optional<double>, 3> v;
  for (std::size_t k = 0; k < 3 && words.size() >= 4; ++k) v[k] = parse<double>(words[k + 1]);
  if (!v[0] || !v[1] || !v[2]) return in_line("is not 'v X Y Z' with three numbers");
  if (cloud_.points.size() == std::numeric_limits<std::uint32_t>::max()) {
    return malformed("it has more than 4,294,967,295 vertices");
  }
  cloud_.points.emplace_back(*v[0], *v[1], *v[2]);
  return success();
}

// A polygon becomes a fan, which covers it even where it is not convex; a line triangles without
// area.
Status ObjReader::take_corners(const Words& words) {
  const bool face = words[0] == "f";
  std::vector<std::uint32_t> corners;
  for (std::size_t i = 1; i < words.size(); ++i) {
    const auto corner = vertex_of(words[i]);
    if (!corner) return corner.error();
    corners.push_back(*corner);
  }
  if (corners.size() < (face ? 3U : 2U)) return in_line("names too few vertices");
  for (std::size_t i = face ? 2 : 1; i < corners.size(); ++i) {
    const std::uint32_t first = face ? corners[0] : corners[i];
    cloud_.triangles.push_back({first, corners[i - 1], corners[i]});
  }
  return success();
}

// "7", "7/2", "7/2/3" or "7//3": vertices count from 1, or from the newest with -1.
Result<std::uint32_t> ObjReader::vertex_of(std::string_view word) const {
  const auto number = parse<std::int64_t>(word.substr(0, word.find('/')));
  const auto count = std::int64_t(cloud_.points.size());
  const std::int64_t index = !number ? -1 : *number < 0 ? count + *number : *number - 1;
  if (index < 0 || index >= count) {
    return in_line(
        fmt::format("names the vertex '{}' of the {} before it: the file is damaged", word, count));
  }
  return std::uint32_t(index);
}

}  // namespace

Result<Cloud> read_obj(std::string_view bytes) {
  return ObjReader(bytes).read();
}

}  // namespace goshawk::map_server
