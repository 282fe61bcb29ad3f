#include "goshawk/worlds/cylinder_forest.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "goshawk/worlds/python_random.hpp"

namespace goshawk::worlds {
namespace {

constexpr int kAttempts = 2000;
constexpr int kShrinksFrom = 1000;

Status check(const CylinderForest& f) {
  const auto ordered = [](double lo, double hi) {
    return std::isfinite(lo) && std::isfinite(hi) && lo <= hi;
  };
  const bool sizes = ordered(f.radius_min_m, f.radius_max_m) && f.radius_min_m > 0.0 &&
                     ordered(f.height_min_m, f.height_max_m) && f.height_min_m > 0.0;
  const double widest_m = 2.0 * f.radius_max_m;
  const bool fits =
      ordered(f.x_min_m + widest_m, f.x_max_m) && ordered(f.y_min_m + widest_m, f.y_max_m);
  if (sizes && fits && f.density > 0.0 && f.density < 1.0 && f.clearance_m.value_or(0.0) >= 0.0) {
    return success();
  }
  return fail(
      ErrorCode::invalid_parameter,
      "a forest of cylinders needs radii and heights above zero, a rectangle that holds the "
      "widest of them, a density between 0 and 1 and a clearance of at least zero");
}

bool keeps_apart(const std::vector<Cylinder>& trees, const Cylinder& tree, double clearance_m) {
  return std::ranges::all_of(trees, [&](const Cylinder& other) {
    return std::hypot(tree.x_m - other.x_m, tree.y_m - other.y_m) >=
           tree.radius_m + other.radius_m + clearance_m;
  });
}

// The order of the random numbers is that of the published generators.
std::optional<Cylinder> draw(const CylinderForest& f, const std::vector<Cylinder>& trees,
                             PythonRandom& random) {
  Cylinder tree;
  tree.height_m = random.uniform(f.height_min_m, f.height_max_m);
  tree.radius_m = random.uniform(f.radius_min_m, f.radius_max_m);
  for (int attempt = 0; attempt < kAttempts; ++attempt) {
    if (attempt >= kShrinksFrom) tree.radius_m = std::max(tree.radius_m / 2.0, f.radius_min_m);
    tree.x_m = random.uniform(f.x_min_m + tree.radius_m, f.x_max_m - tree.radius_m);
    tree.y_m = random.uniform(f.y_min_m + tree.radius_m, f.y_max_m - tree.radius_m);
    if (!f.clearance_m || keeps_apart(trees, tree, *f.clearance_m)) return tree;
  }
  return {};
}

}  // namespace

CylinderForest sando_forest(double density) {
  CylinderForest forest;
  forest.density = density;
  return forest;
}

CylinderForest mighty_forest() {
  CylinderForest forest;
  forest.x_max_m = 303.0;
  forest.density = 0.4;
  forest.clearance_m = 1.2;
  return forest;
}

CylinderForest dynus_forest(double density) {
  CylinderForest forest;
  forest.x_min_m = 1.0;
  forest.x_max_m = 101.0;
  forest.radius_min_m = 0.2;
  forest.radius_max_m = 1.0;
  forest.height_min_m = 1.0;
  forest.height_max_m = 5.0;
  forest.density = density;
  forest.clearance_m.reset();
  return forest;
}

Result<std::vector<Cylinder>> make_cylinders(const CylinderForest& forest) {
  if (auto status = check(forest); !status) return status.error();
  PythonRandom random(forest.seed);
  std::vector<Cylinder> trees;
  const double rectangle_m2 = (forest.x_max_m - forest.x_min_m) * (forest.y_max_m - forest.y_min_m);
  for (double covered_m2 = 0.0; covered_m2 < forest.density * rectangle_m2;) {
    const auto tree = draw(forest, trees, random);
    if (!tree) break;
    trees.push_back(*tree);
    covered_m2 += std::numbers::pi * tree->radius_m * tree->radius_m;
  }
  return trees;
}

}  // namespace goshawk::worlds
