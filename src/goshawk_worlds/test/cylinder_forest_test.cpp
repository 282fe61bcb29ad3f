// Published worlds, against the figures of the worlds as they were shipped.
#include "goshawk/worlds/cylinder_forest.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "goshawk/worlds/python_random.hpp"

namespace goshawk::worlds {
namespace {

double area_m2(const std::vector<Cylinder>& trees) {
  double area = 0.0;
  for (const Cylinder& t : trees) area += std::numbers::pi * t.radius_m * t.radius_m;
  return area;
}

double smallest_gap_m(const std::vector<Cylinder>& trees) {
  double gap = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < trees.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      gap = std::min(gap, std::hypot(trees[i].x_m - trees[j].x_m, trees[i].y_m - trees[j].y_m) -
                              trees[i].radius_m - trees[j].radius_m);
    }
  }
  return gap;
}

void expect_tree(const Cylinder& tree, double x_m, double y_m, double radius_m) {
  EXPECT_NEAR(tree.x_m, x_m, 1e-4);
  EXPECT_NEAR(tree.y_m, y_m, 1e-4);
  EXPECT_NEAR(tree.radius_m, radius_m, 1e-5);
}

TEST(PythonRandom, DrawsWhatCPythonDraws) {
  PythonRandom random(0);
  EXPECT_EQ(random.uniform(), 0.8444218515250481);
  EXPECT_EQ(random.uniform(), 0.7579544029403025);
  EXPECT_EQ(random.uniform(), 0.420571580830845);
  PythonRandom other(42);
  EXPECT_EQ(other.uniform(), 0.6394267984578837);
}

TEST(CylinderForest, SandosForestsAreTheShippedOnes) {
  const auto easy = make_cylinders(sando_forest(0.05)).value();
  const auto medium = make_cylinders(sando_forest(0.1)).value();
  const auto hard = make_cylinders(sando_forest(0.2)).value();
  ASSERT_EQ(easy.size(), 41u);
  ASSERT_EQ(medium.size(), 81u);
  ASSERT_EQ(hard.size(), 162u);
  expect_tree(easy[0], 45.2762, -8.9784, 1.37898);
  EXPECT_NEAR(area_m2(easy), 203.5, 0.05);
  EXPECT_NEAR(area_m2(medium), 402.6, 0.05);
  EXPECT_NEAR(area_m2(hard), 803.1, 0.05);
  for (std::size_t i = 0; i < easy.size(); ++i) {
    EXPECT_EQ(easy[i].x_m, hard[i].x_m);
    EXPECT_EQ(easy[i].height_m, 6.0);
  }
  EXPECT_GE(smallest_gap_m(hard), 1.5);
}

TEST(CylinderForest, MightysForestIsFullAfterItsLastTree) {
  const auto trees = make_cylinders(mighty_forest()).value();
  ASSERT_EQ(trees.size(), 569u);
  expect_tree(trees.front(), 129.3905, -8.9784, 1.37898);
  expect_tree(trees.back(), 21.7754, 10.4823, 1.0);
  EXPECT_NEAR(area_m2(trees), 2804.1, 0.05);
  EXPECT_NEAR(smallest_gap_m(trees), 1.208, 5e-4);
}

TEST(CylinderForest, DynussForestsOverlap) {
  EXPECT_EQ(make_cylinders(dynus_forest(0.05)).value().size(), 166u);
  EXPECT_EQ(make_cylinders(dynus_forest(0.1)).value().size(), 316u);
  const auto hard = make_cylinders(dynus_forest(0.2)).value();
  EXPECT_EQ(hard.size(), 629u);
  EXPECT_LT(smallest_gap_m(hard), 0.0);
}

TEST(CylinderForest, AnotherSeedIsAnotherForest) {
  auto forest = sando_forest(0.05);
  const double first_m = make_cylinders(forest).value()[0].x_m;
  forest.seed = 1;
  EXPECT_NE(make_cylinders(forest).value()[0].x_m, first_m);
}

TEST(CylinderForest, WhatCannotBeIsRefused) {
  const auto refused = [](auto change) {
    CylinderForest forest;
    change(forest);
    const auto made = make_cylinders(forest);
    return !made && made.error().code == ErrorCode::invalid_parameter;
  };
  EXPECT_TRUE(refused([](CylinderForest& f) { f.density = 0.0; }));
  EXPECT_TRUE(refused([](CylinderForest& f) { f.density = 1.0; }));
  EXPECT_TRUE(refused([](CylinderForest& f) { f.radius_min_m = 2.0; }));
  EXPECT_TRUE(refused([](CylinderForest& f) { f.x_max_m = f.x_min_m + 2.9; }));
  EXPECT_TRUE(refused([](CylinderForest& f) { f.clearance_m = -0.1; }));
  EXPECT_TRUE(refused([](CylinderForest& f) { f.height_min_m = std::nan(""); }));
}

}  // namespace
}  // namespace goshawk::worlds
