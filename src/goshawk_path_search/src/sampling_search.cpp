// The only file that sees OMPL: its headers take longer to compile than all the others together.
#include "goshawk/path_search/sampling_search.hpp"

#include <ompl/base/MotionValidator.h>
#include <ompl/base/PlannerData.h>
#include <ompl/base/goals/GoalStates.h>
#include <ompl/base/objectives/PathLengthOptimizationObjective.h>
#include <ompl/base/spaces/RealVectorStateSpace.h>
#include <ompl/geometric/PathGeometric.h>
#include <ompl/geometric/planners/prm/PRM.h>
#include <ompl/geometric/planners/rrt/RRT.h>
#include <ompl/geometric/planners/rrt/RRTstar.h>
#include <ompl/util/Console.h>

#include "goshawk/core/random.hpp"
#include "goshawk/path_search/segment_validity.hpp"

namespace goshawk::path_search {
namespace {

namespace ob = ompl::base;
namespace og = ompl::geometric;

using Space = ob::RealVectorStateSpace;

Vec3 point_of(const ob::State* state) {
  const double* v = state->as<Space::StateType>()->values;
  return {v[0], v[1], v[2]};
}

/// Uniform over the grid, from our own generator: OMPL draws its seeds from one for the process.
class GridSampler final : public ob::StateSampler {
 public:
  GridSampler(const ob::StateSpace* space, std::uint64_t seed)
      : ob::StateSampler(space), random_(seed) {}
  void sampleUniform(ob::State* state) override {
    const ob::RealVectorBounds& bounds = space_->as<Space>()->getBounds();
    double* v = state->as<Space::StateType>()->values;
    for (unsigned a = 0; a < 3; ++a) v[a] = random_.uniform(bounds.low[a], bounds.high[a]);
  }
  void sampleUniformNear(ob::State* state, const ob::State* near, double distance) override {
    const double* from = near->as<Space::StateType>()->values;
    double* v = state->as<Space::StateType>()->values;
    for (unsigned a = 0; a < 3; ++a) v[a] = from[a] + random_.uniform(-distance, distance);
    space_->enforceBounds(state);
  }
  void sampleGaussian(ob::State* state, const ob::State* mean, double deviation) override {
    sampleUniformNear(state, mean, deviation);
  }

 private:
  Random random_;
};

class LineOfSight final : public ob::MotionValidator {
 public:
  LineOfSight(const ob::SpaceInformationPtr& space, const SegmentValidity& validity)
      : ob::MotionValidator(space), validity_(validity) {}
  bool checkMotion(const ob::State* a, const ob::State* b) const override {
    return validity_.is_free(point_of(a), point_of(b));
  }
  // Only asked for where the last valid state matters: nowhere here.
  bool checkMotion(const ob::State* a, const ob::State* b,
                   std::pair<ob::State*, double>& last_valid) const override {
    last_valid.second = 0.0;
    if (last_valid.first != nullptr) si_->copyState(last_valid.first, a);
    return checkMotion(a, b);
  }

 private:
  const SegmentValidity& validity_;
};

struct SeededRrt final : og::RRT {
  SeededRrt(const ob::SpaceInformationPtr& space, std::uint32_t seed) : og::RRT(space) {
    rng_.setLocalSeed(seed);
  }
};

struct SeededRrtStar final : og::RRTstar {
  SeededRrtStar(const ob::SpaceInformationPtr& space, std::uint32_t seed) : og::RRTstar(space) {
    rng_.setLocalSeed(seed);
  }
};

/// OMPL's own solve() looks for the answer in a second thread, at a moment of its own. Here the
/// road map is grown by so many samples and then asked.
struct SteadyPrm final : og::PRM {
  using og::PRM::PRM;
  ob::PlannerStatus solve(const ob::PlannerTerminationCondition& done) override {
    checkValidity();
    setup();
    startM_.push_back(addMilestone(si_->cloneState(pis_.nextStart())));
    while (const ob::State* goal = pis_.nextGoal()) {
      goalM_.push_back(addMilestone(si_->cloneState(goal)));
    }
    if (!sampler_) sampler_ = si_->allocValidStateSampler();
    ob::State* work = si_->allocState();
    while (!done()) {
      ++iterations_;
      if (sampler_->sample(work)) addMilestone(si_->cloneState(work));
    }
    si_->freeState(work);
    ob::PathPtr path;
    // Its answer is whether the length is good enough, not whether there is a path.
    (void)maybeConstructSolution(startM_, goalM_, path);
    if (!path) return ob::PlannerStatus::TIMEOUT;
    pdef_->addSolutionPath(path);
    return ob::PlannerStatus::EXACT_SOLUTION;
  }
};

class SamplingSearch final : public GridPlanner {
 public:
  SamplingSearch(Planner planner, const SamplingOptions& options)
      : planner_(planner), options_(options) {
    ompl::msg::noOutputHandler();
  }

  using GridPlanner::search;
  using GridPlanner::set_map;
  std::string_view name() const override { return to_word(planner_); }
  void set_map(const BitGrid& blocked, const BitGrid*) override;
  Status search(const GridQuery& query, VoxelPath& path) override;

 private:
  ob::SpaceInformationPtr make_space() const;
  ob::PlannerPtr make_planner(const ob::SpaceInformationPtr& space) const;
  ob::ProblemDefinitionPtr make_problem(const ob::SpaceInformationPtr& space,
                                        const GridQuery& query) const;
  Status direct(const GridQuery& query, VoxelPath& path) const;
  void take(og::PathGeometric& found, const GridQuery& query, VoxelPath& path) const;

  Planner planner_;
  SamplingOptions options_;
  BitGrid blocked_;
  std::unique_ptr<SegmentValidity> validity_;  // of blocked_
};

void SamplingSearch::set_map(const BitGrid& blocked, const BitGrid*) {
  blocked_ = blocked;
  validity_ = options_.validity == Validity::fcl ? make_fcl_validity(blocked_)
                                                 : make_grid_validity(blocked_);
}

ob::SpaceInformationPtr SamplingSearch::make_space() const {
  auto space = std::make_shared<Space>(3);
  ob::RealVectorBounds bounds(3);
  const Index3 size = blocked_.size();
  bounds.high = {double(size.x), double(size.y), double(size.z)};
  space->setBounds(bounds);
  std::uint64_t seed = options_.seed;
  space->setStateSamplerAllocator(
      [seed](const ob::StateSpace* s) mutable { return std::make_shared<GridSampler>(s, seed++); });
  auto information = std::make_shared<ob::SpaceInformation>(space);
  information->setStateValidityChecker([this](const ob::State* state) {
    const Vec3 p = point_of(state);
    return validity_->is_free(p, p);
  });
  information->setMotionValidator(std::make_shared<LineOfSight>(information, *validity_));
  information->setup();
  return information;
}

ob::PlannerPtr SamplingSearch::make_planner(const ob::SpaceInformationPtr& space) const {
  const auto seed = std::uint32_t(options_.seed % 0xFFFFFFFFU) + 1;  // OMPL: 0 is no seed
  if (planner_ == Planner::prm) return std::make_shared<SteadyPrm>(space);
  if (planner_ == Planner::rrt) {
    auto rrt = std::make_shared<SeededRrt>(space, seed);
    rrt->setRange(options_.step_voxels);
    return rrt;
  }
  auto star = std::make_shared<SeededRrtStar>(space, seed);
  star->setRange(options_.step_voxels);
  return star;
}

ob::ProblemDefinitionPtr SamplingSearch::make_problem(const ob::SpaceInformationPtr& space,
                                                      const GridQuery& query) const {
  auto problem = std::make_shared<ob::ProblemDefinition>(space);
  const auto state_of = [&](const Vec3& p) {
    ob::ScopedState<Space> state(space);
    for (unsigned a = 0; a < 3; ++a) state->values[a] = p[int(a)];
    return state;
  };
  problem->addStartState(state_of(query.start.at_grid));
  auto goals = std::make_shared<ob::GoalStates>(space);
  for (const End& goal : query.goals) goals->addState(state_of(goal.at_grid));
  problem->setGoal(goals);
  problem->setOptimizationObjective(std::make_shared<ob::PathLengthOptimizationObjective>(space));
  return problem;
}

// Where a straight line will do, and where start and goal are one: nothing to sample.
Status SamplingSearch::direct(const GridQuery& query, VoxelPath& path) const {
  for (std::size_t k = 0; k < query.goals.size(); ++k) {
    const Vec3 &a = query.start.at_grid, &b = query.goals[k].at_grid;
    if (!validity_->is_free(a, b)) continue;
    const double length = (b - a).norm();
    if (!path.points.empty() && length >= path.cost_voxels) continue;
    path.points = {a, b};
    path.cost_voxels = length;
    path.goal = k;
  }
  return success();
}

Status SamplingSearch::search(const GridQuery& query, VoxelPath& path) {
  path.clear();
  if (blocked_.empty()) {
    return fail(ErrorCode::no_map, "no map yet: wait for one, or load one, before planning");
  }
  auto status = check_ends(query, blocked_.size(), [this](Index3 i) { return blocked_.get(i); });
  if (!status) return status;
  (void)direct(query, path);
  if (!path.points.empty()) return success();
  status = success();
  std::int64_t asked = 0;
  const ob::PlannerTerminationCondition done([&] {
    if (status && asked % 64 == 0) status = query.stop.check();
    return !status || ++asked > options_.max_iterations;
  });
  const auto space = make_space();
  const auto problem = make_problem(space, query);
  const auto planner = make_planner(space);
  planner->setProblemDefinition(problem);
  planner->setup();
  const bool solved = planner->solve(done) == ob::PlannerStatus::EXACT_SOLUTION;
  ob::PlannerData data(space);
  planner->getPlannerData(data);
  path.counters = {std::min<std::int64_t>(asked, options_.max_iterations),
                   std::int64_t(data.numVertices())};
  if (status.code() == ErrorCode::cancelled) return status;
  if (!solved) {
    return status
               ? Status(fail(ErrorCode::no_path,
                             "no path was found with " + std::to_string(options_.max_iterations) +
                                 " samples, which does not prove that there is none: raise "
                                 "max_iterations, or use planner jastar"))
               : status;
  }
  take(*problem->getSolutionPath()->as<og::PathGeometric>(), query, path);
  return success();
}

void SamplingSearch::take(og::PathGeometric& found, const GridQuery& query, VoxelPath& path) const {
  for (const ob::State* state : found.getStates()) path.points.push_back(point_of(state));
  for (std::size_t i = 1; i < path.points.size(); ++i) {
    path.cost_voxels += (path.points[i] - path.points[i - 1]).norm();
  }
  double nearest = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < query.goals.size(); ++k) {
    const double d = (path.points.back() - query.goals[k].at_grid).norm();
    if (d < nearest) {
      nearest = d;
      path.goal = k;
    }
  }
}

}  // namespace

std::unique_ptr<GridPlanner> make_sampling_search(Planner planner, const SamplingOptions& options) {
  if (planner != Planner::rrt && planner != Planner::rrtstar && planner != Planner::prm) {
    throw std::invalid_argument("make_sampling_search() of a planner that does not sample");
  }
  return std::make_unique<SamplingSearch>(planner, options);
}

}  // namespace goshawk::path_search
