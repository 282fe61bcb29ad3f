#include "builder.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>

#include "goshawk/core/inflation.hpp"

namespace goshawk::worlds {
namespace {

using Word = BitGrid::Word;

// The part of the world around a shape that its growth can reach, whole words along x.
struct Window {
  Index3 lower;
  Index3 size;
  std::size_t first_word() const { return std::size_t(lower.x) / 64; }
};

Window window_around(const Shape& shape, int reach, Index3 world) {
  const auto lower = [&](int at) { return std::max(0, at - reach); };
  const auto upper = [&](int at, int n, int limit) { return std::min(limit, at + n + reach); };
  const Index3 n = shape.voxels.size();
  const Index3 lo{lower(shape.lower.x) & ~63, lower(shape.lower.y), lower(shape.lower.z)};
  const int hi_x = std::min((upper(shape.lower.x, n.x, world.x) + 63) & ~63, world.x);
  const Index3 hi{hi_x, upper(shape.lower.y, n.y, world.y), upper(shape.lower.z, n.z, world.z)};
  return {lo, hi - lo};
}

// The shape within the window, what sticks out cut off.
BitGrid place(const Shape& shape, const Window& window) {
  BitGrid local(window.size, false);
  const Index3 n = shape.voxels.size();
  for (int z = 0; z < n.z; ++z) {
    for (int y = 0; y < n.y; ++y) {
      for (int x = 0; x < n.x; ++x) {
        const Index3 at = Index3{x, y, z} + shape.lower - window.lower;
        if (shape.voxels.get({x, y, z}) && local.contains(at)) local.set(at, true);
      }
    }
  }
  return local;
}

// Calls visit(world words, local words, word count) for each row of the window.
template <typename Visit>
void for_rows(BitGrid& world, const BitGrid& local, const Window& window, Visit&& visit) {
  for (int z = 0; z < window.size.z; ++z) {
    for (int y = 0; y < window.size.y; ++y) {
      visit(world.mutable_row(y + window.lower.y, z + window.lower.z) + window.first_word(),
            local.row(y, z), local.words_per_row());
    }
  }
}

// Every voxel whose closed cube holds a keep_free point, with slack for rounding.
BitGrid keep_free_voxels(const WorldSpec& spec, const GridGeometry& geometry) {
  BitGrid keep(geometry.size, false);
  for (const Vec3& p : spec.keep_free) {
    const Vec3 g = geometry.to_grid(p);
    const auto from = [](double v) { return int(std::ceil(v - 1e-6)) - 1; };
    const auto to = [](double v) { return int(std::floor(v + 1e-6)); };
    for (int z = from(g.z()); z <= to(g.z()); ++z) {
      for (int y = from(g.y()); y <= to(g.y()); ++y) {
        for (int x = from(g.x()); x <= to(g.x()); ++x) {
          if (keep.contains({x, y, z})) keep.set({x, y, z}, true);
        }
      }
    }
  }
  return keep;
}

}  // namespace

Shape solid_box(Index3 lower, Index3 size) {
  return {lower, BitGrid(size, false, true)};
}

Builder::Builder(const WorldSpec& spec, const GridGeometry& geometry)
    : geometry_(geometry),
      inflation_m_(spec.inflation_m),
      reach_(int(std::ceil(std::min(spec.inflation_m / spec.resolution_m, 65536.0))) + 1),
      occupied_(geometry.size, true),
      grown_(geometry.size, false),
      protected_(keep_free_voxels(spec, geometry)),
      keep_free_(protected_) {}

int Builder::voxels_of(double length_m) const {
  return std::max(1, int(std::ceil(length_m / geometry_.resolution_m - 1e-6)));
}

bool Builder::try_add(const Shape& shape, double max_share) {
  const Window window = window_around(shape, reach_, size());
  if (window.size.x < 1 || window.size.y < 1 || window.size.z < 1) return false;
  const BitGrid local = place(shape, window);
  const BitGrid growth = inflate(local, inflation_m_, geometry_.resolution_m).value();

  std::int64_t added = 0;
  bool forbidden = false;
  for_rows(grown_, growth, window, [&](const Word* world, const Word* grow, std::size_t n) {
    for (std::size_t i = 0; i < n; ++i) added += std::popcount(grow[i] & ~world[i]);
  });
  for_rows(protected_, growth, window, [&](const Word* world, const Word* grow, std::size_t n) {
    for (std::size_t i = 0; i < n; ++i) forbidden = forbidden || (grow[i] & world[i]) != 0;
  });
  if (forbidden || added == 0) return false;
  if (double(blocked_ + added) > max_share * double(occupied_.voxels())) return false;

  const auto merge = [](Word* world, const Word* other, std::size_t n) {
    for (std::size_t i = 0; i < n; ++i) world[i] |= other[i];
  };
  for_rows(grown_, growth, window, merge);
  for_rows(occupied_, local, window, merge);
  blocked_ += added;
  return true;
}

void Builder::write(const Shape& shape, bool value) {
  const Index3 n = shape.voxels.size();
  for (int z = 0; z < n.z; ++z) {
    for (int y = 0; y < n.y; ++y) {
      for (int x = 0; x < n.x; ++x) {
        const Index3 at = Index3{x, y, z} + shape.lower;
        if (shape.voxels.get({x, y, z}) && occupied_.contains(at)) occupied_.set(at, value);
      }
    }
  }
}

void Builder::protect(const Shape& shape) {
  const Window window = window_around(shape, 0, size());
  if (window.size.x < 1 || window.size.y < 1 || window.size.z < 1) return;
  for_rows(protected_, place(shape, window), window,
           [](Word* world, const Word* other, std::size_t n) {
             for (std::size_t i = 0; i < n; ++i) world[i] |= other[i];
           });
}

void Builder::refresh() {
  // Growth is symmetric: the voxels that would block a kept one are those in its own growth.
  const BitGrid clear = inflate(keep_free_, inflation_m_, geometry_.resolution_m).value();
  for (int z = 0; z < size().z; ++z) {
    for (int y = 0; y < size().y; ++y) {
      Word* row = occupied_.mutable_row(y, z);
      for (std::size_t i = 0; i < occupied_.words_per_row(); ++i) row[i] &= ~clear.row(y, z)[i];
    }
  }
  const BitGrid grown = inflate(occupied_, inflation_m_, geometry_.resolution_m).value();
  blocked_ = grown.count();
  grown_ = BitGrid::from_words(size(), false, grown.to_words()).value();
}

Status fill_to_density(Builder& builder, double density,
                       const std::function<Shape(double scale)>& draw) {
  constexpr int kPatience = 20000;  // fruitless draws in a row
  constexpr int kDrawsBeforeShrinking = 12;
  const double aim = density - 0.5 * kDensityTolerance;
  const double most = density + 0.5 * kDensityTolerance;
  int failures = 0;
  double scale = 1.0;
  while (builder.share() < aim && failures < kPatience) {
    if (builder.try_add(draw(scale), most)) {
      failures = 0;
    } else if (++failures % kDrawsBeforeShrinking == 0) {
      scale *= 0.8;
    }
  }
  if (std::abs(builder.share() - density) <= kDensityTolerance) return success();
  return fail(ErrorCode::invalid_parameter,
              fmt::format("a density of {:.3f} was not reached, only {:.3f}: use a larger world, a "
                          "finer resolution, a smaller inflation or another density",
                          density, builder.share()));
}

}  // namespace goshawk::worlds
