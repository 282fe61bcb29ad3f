// A repeated solve must not allocate: operator new of this program counts.
#include <gtest/gtest.h>

#include <atomic>
#include <cstdlib>
#include <new>

#include "corridor_maker.hpp"
#include "goshawk/trajectory_optimizer/active_set_solver.hpp"
#include "goshawk/trajectory_optimizer/plan_problem.hpp"
#include "goshawk/trajectory_optimizer/spline_solver.hpp"

namespace {
std::atomic<long> allocations{0};

void* counted(std::size_t bytes, std::size_t alignment) {
  ++allocations;
  const std::size_t rounded = (bytes + alignment - 1) / alignment * alignment;
  void* memory = std::aligned_alloc(alignment, rounded);
  if (memory == nullptr) throw std::bad_alloc();
  return memory;
}
}  // namespace

// Not inlined: the compiler would see aligned_alloc() against operator delete, and warn.
[[gnu::noinline]] void* operator new(std::size_t bytes) {
  return counted(bytes, alignof(std::max_align_t));
}
[[gnu::noinline]] void* operator new(std::size_t bytes, std::align_val_t alignment) {
  return counted(bytes, std::size_t(alignment));
}
[[gnu::noinline]] void operator delete(void* memory) noexcept {
  std::free(memory);
}
[[gnu::noinline]] void operator delete(void* memory, std::size_t) noexcept {
  std::free(memory);
}
[[gnu::noinline]] void operator delete(void* memory, std::align_val_t) noexcept {
  std::free(memory);
}
[[gnu::noinline]] void operator delete(void* memory, std::size_t, std::align_val_t) noexcept {
  std::free(memory);
}

namespace goshawk::trajectory_optimizer {
namespace {

TEST(SplineSolver, AllocatesNothingOnceItHasSeenAProblemOfThatSize) {
  Random random(14);
  for (const bool scale : {true, false}) {
    for (const LimitNorm norm :
         {LimitNorm::euclidean, LimitNorm::per_axis, LimitNorm::horizontal_vertical}) {
      const auto corridor = test::random_corridor(random, {});
      const Limits limits{.norm = norm, .j_max_m_s3 = 8.0};
      const PlanRequest request = test::ask(corridor, limits);
      Plan plan = cut_trapezoid(request, corridor, {});
      for (double& duration : plan.durations_s) duration *= 3.0;
      const ProblemSettings settings{.scale = scale, .time_weight = 100.0};
      SplineProblem problem;
      Units units;
      SplineSolver solver;
      ASSERT_TRUE(make_problem(request, corridor, plan, settings, problem, units));
      const auto first = solver.solve(problem, {});
      const long before = allocations;
      ASSERT_TRUE(make_problem(request, corridor, plan, settings, problem, units));
      const auto second = solver.solve(problem, {});
      EXPECT_EQ(allocations, before);
      EXPECT_EQ(first.status, SplineSolver::Status::solved);
      EXPECT_EQ(second.objective, first.objective);
    }
  }
}

TEST(ActiveSetSolver, AllocatesNothingOnceItHasSeenAProblemOfThatSize) {
  Random random(15);
  const auto corridor = test::random_corridor(random, {});
  const Limits limits{.j_max_m_s3 = 8.0};
  const PlanRequest request = test::ask(corridor, limits);
  Plan plan = cut_trapezoid(request, corridor, {});
  for (double& duration : plan.durations_s) duration *= 2.0;
  SplineProblem problem;
  Units units;
  ActiveSetSolver solver;
  ASSERT_TRUE(make_problem(request, corridor, plan, {.scale = false}, problem, units));
  const auto first = solver.solve(problem, {});
  ASSERT_EQ(first.status, SplineSolver::Status::solved);
  EXPECT_GE(solver.binding(), 1);
  const long before = allocations;
  const auto second = solver.solve(problem, {});
  EXPECT_EQ(allocations, before);
  EXPECT_EQ(second.objective, first.objective);
}

}  // namespace
}  // namespace goshawk::trajectory_optimizer
