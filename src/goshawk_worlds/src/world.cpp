#include "goshawk/worlds/world.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "builder.hpp"

namespace goshawk::worlds {
namespace {

// A generator touches every voxel; beyond this it would rather be a mistake in the units.
constexpr std::int64_t kMaxWorldVoxels = 1'000'000'000;

Error bad(const std::string& what) {
  return fail(ErrorCode::invalid_parameter, what);
}

Status check(const WorldSpec& spec) {
  if (!(std::isfinite(spec.resolution_m) && spec.resolution_m > 0.0)) {
    return bad("the world's resolution is " + fmt::format("{}", spec.resolution_m) +
               " m: it must be finite and above zero");
  }
  if (!is_finite(spec.size_m) || spec.size_m.minCoeff() <= 0.0) {
    return bad("the world's size is " + to_text(spec.size_m) +
               " m: each side must be finite and above zero");
  }
  if (!is_finite(spec.origin_m)) return bad("the world's origin is not finite");
  if (!(spec.density >= 0.0 && spec.density <= 0.95)) {
    return bad("the world's density is " + fmt::format("{}", spec.density) +
               ": it must lie between 0 and 0.95");
  }
  if (!(spec.inflation_m >= 0.0 && spec.inflation_m <= spec.size_m.maxCoeff())) {
    return bad("the world's inflation is " + fmt::format("{}", spec.inflation_m) +
               " m: it must be at least zero and at most the world's longest side");
  }
  return success();
}

Result<GridGeometry> geometry_of(const WorldSpec& spec) {
  const Vec3 n = spec.size_m / spec.resolution_m;
  if (n.maxCoeff() > 65536.0) {
    return fail(ErrorCode::map_too_large,
                "a world of " + to_text(spec.size_m) + " m at " +
                    fmt::format("{}", spec.resolution_m) +
                    " m has more than 65536 voxels on a side: use a coarser resolution");
  }
  const auto voxels = [](double v) { return std::max(1, int(std::ceil(v - 1e-6))); };
  GridGeometry geometry{
      spec.origin_m, spec.resolution_m, {voxels(n.x()), voxels(n.y()), voxels(n.z())}};
  const Index3 s = geometry.size;
  if (std::int64_t{s.x} * s.y > kMaxWorldVoxels / s.z) {
    return fail(ErrorCode::map_too_large, "a world of " + to_text(s) +
                                              " voxels is above the limit of 10^9: use a coarser "
                                              "resolution or a smaller size");
  }
  return geometry;
}

Status check_keep_free(const WorldSpec& spec, const GridGeometry& geometry) {
  const Vec3 limit(geometry.size.x, geometry.size.y, geometry.size.z);
  for (const Vec3& p : spec.keep_free) {
    const Vec3 g = geometry.to_grid(p);
    if (!is_finite(p) || (g.array() < 0.0).any() || (g.array() > limit.array()).any()) {
      return fail(ErrorCode::invalid_input,
                  "the point " + to_text(p) +
                      " is to stay free but lies outside the world, which "
                      "spans " +
                      to_text(geometry.origin_map) + " to " + to_text(geometry.upper_corner_map()) +
                      " m");
    }
  }
  return success();
}

}  // namespace

const std::vector<std::string>& world_kinds() {
  static const std::vector<std::string> kinds{"boxes", "forest", "noise", "office"};
  return kinds;
}

WorldSpec default_world() {
  WorldSpec spec;
  spec.kind = "boxes";
  spec.size_m = Vec3(6.0, 8.8, 4.0);
  spec.origin_m = Vec3(0.0, -0.4, 0.0);
  spec.density = 0.4;
  spec.keep_free = {Vec3(3.0, 0.0, 1.0), Vec3(3.0, 8.0, 2.0)};
  return spec;
}

Result<World> make_world(const WorldSpec& spec) {
  if (auto status = check(spec); !status) return status.error();
  const auto geometry = geometry_of(spec);
  if (!geometry) return geometry.error();
  if (auto status = check_keep_free(spec, *geometry); !status) return status.error();

  if (spec.kind == "noise") return make_noise(spec, *geometry);
  if (spec.kind == "boxes") return make_boxes(spec, *geometry);
  if (spec.kind == "forest") return make_forest(spec, *geometry);
  if (spec.kind == "office") return make_office(spec, *geometry);
  return bad("no kind of world is called '" + spec.kind + "': use boxes, forest, noise or office");
}

}  // namespace goshawk::worlds
