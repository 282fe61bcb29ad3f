#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "goshawk/core/result.hpp"
#include "goshawk/core/vector.hpp"

namespace goshawk::worlds {

/// An upright cylinder that stands on z = 0.
struct Cylinder {
  double x_m = 0.0, y_m = 0.0;
  double radius_m = 0.0;
  double height_m = 0.0;
};

/// The forests of SANDO, MIGHTY and DYNUS (generate_random_forest.py of each; MIT ACL): cylinders
/// that lie wholly in a rectangle, added until their areas make up a share of it. The same seed
/// gives their very worlds.
struct CylinderForest {
  double x_min_m = 3.0, x_max_m = 103.0;
  double y_min_m = -20.0, y_max_m = 20.0;
  double radius_min_m = 1.0, radius_max_m = 1.5;
  double height_min_m = 6.0, height_max_m = 6.0;
  double density = 0.1;  // summed areas over the rectangle's; what overlaps counts twice
  /// [m] least distance between two surfaces; nothing: they may overlap
  std::optional<double> clearance_m = 1.5;
  std::uint32_t seed = 0;
};

/// SANDO, static forest: easy 0.05, medium 0.1, hard 0.2 (arXiv 2604.07599, IX-C).
CylinderForest sando_forest(double density);
/// MIGHTY, 300 m (arXiv 2511.10822, IV-F): as dense as it gets with 1.2 m between the trees.
CylinderForest mighty_forest();
/// DYNUS (arXiv 2504.16734, VII-A): thin cylinders of all heights that may overlap.
CylinderForest dynus_forest(double density);

/// Ends early if 2,000 places in a row do not fit; from the thousandth on the cylinder shrinks.
/// @return invalid_parameter for ranges that are empty or not finite, or a density outside (0, 1)
Result<std::vector<Cylinder>> make_cylinders(const CylinderForest& forest);

}  // namespace goshawk::worlds
