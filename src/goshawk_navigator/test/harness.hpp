#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <memory>
#include <utility>
#include <vector>

#include "goshawk/navigator/navigator.hpp"

namespace goshawk::navigator {

inline constexpr std::int64_t kSecond = 1'000'000'000;
inline constexpr std::int64_t kStep = kSecond / 50;
inline const Vec3 kHome(0, 0, 1);
inline const Vec3 kGoal(4, 0, 1);

inline Error ok() {
  return {ErrorCode::ok, ""};
}

RigidBodyState at(const Vec3& position, const Vec3& velocity = Vec3::Zero(), double yaw_rad = 0.0);

/// Limits that every quintic keeps.
Config wide(Config config = {});

/// A hundred metres around the origin, free, in voxels of a metre.
VoxelGrid free_map(std::uint64_t version = 5);
/// Such a map with a wall across x, one voxel thick.
VoxelGrid map_with_wall(double x_m, std::uint64_t version);

/// Plays the other stages, the tracker and the vehicle.
class Harness {
 public:
  explicit Harness(const Config& config = {});

  void goal(const Vec3& g);
  void take();
  /// Time passes; the vehicle is where the newest committed trajectory has it.
  void pass(double seconds);
  Commitment solve(const PlanRequest& request, double duration_s = 4.0);
  /// All stages answer the newest request.
  void answer(double duration_s = 4.0);
  /// All stages answer the newest request with a plan for the first part of a longer path.
  /// @param beyond_m what the corridor builder says that the path goes on for
  void answer_up_to(const Vec3& end, double beyond_m, double duration_s);
  /// A stage says that the newest request has failed.
  void fails(ErrorCode code, StageRole stage = StageRole::trajectory_optimizer,
             const std::string& message = "");
  void tracker_says(std::uint64_t id, const Error& outcome);
  void map(VoxelGrid grid);

  FlatState vehicle() const;
  StateOrder last() const { return states.back(); }

  Navigator navigator;
  std::int64_t now = 10 * kSecond;
  bool odometry_comes = true;
  Vec3 offset = Vec3::Zero();
  Vec3 drift = Vec3::Zero();  // [m/s] of a vehicle that something else moves
  double yaw_rad = 0.0;
  std::optional<YawCurve> yaw_curve;  // of the answers
  std::uint64_t map_version = 5;      // of the answers
  std::uint64_t answers = 0;
  std::vector<PlanRequest> plans;
  std::vector<CommittedTrajectory> commits;
  std::vector<Complaint> complaints;
  std::vector<StateOrder> states;
  /// As the tracker has them, newest last.
  std::vector<std::pair<Trajectory, std::int64_t>> flown;
};

}  // namespace goshawk::navigator
