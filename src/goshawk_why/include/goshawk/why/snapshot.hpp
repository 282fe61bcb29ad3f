#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "goshawk/core/committed_trajectory.hpp"
#include "goshawk/core/grid_geometry.hpp"
#include "goshawk/core/stage_role.hpp"

namespace goshawk::why {

/// What a flight's stages have last reported, at one moment. Ages count from the arrival of the
/// newest message on each topic. Frame `map`.
struct Snapshot {
  struct Vehicle {
    Vec3 position_map = Vec3::Zero();
    double speed_m_s = 0.0;
    double age_s = 0.0;
  };
  /// Who controls the vehicle, by its own report.
  struct Status {
    enum class Control { nobody, goshawk, pilot, autopilot };
    bool armed = true;
    Control control = Control::goshawk;
    bool failsafe = false;
  };
  struct Navigator {
    enum class State { idle, planning, flying, arrived, failed, held };
    State state = State::idle;
    std::uint64_t request_id = 0;
    Vec3 goal_map = Vec3::Zero();
    Error reason{ErrorCode::ok, ""};
    double since_s = 0.0;  // the state is as old as this
    double age_s = 0.0;    // of the newest sign of life
  };
  struct Tracker {
    enum class Mode { idle, hold, follow, brake, land };
    Mode mode = Mode::idle;
    double age_s = 0.0;
  };
  /// The newest report of a stage.
  struct Report {
    StageRole stage = StageRole::other;
    std::uint64_t request_id = 0;
    Error outcome{ErrorCode::ok, ""};
  };
  /// What is flown, or held at its end.
  struct Flown {
    CommittedTrajectory committed;
    double time_s = 0.0;  // since its start
  };
  struct Mission {
    bool waits = false;  // paused, or failed
    std::string message = {};
  };

  std::optional<Vehicle> vehicle = {};
  std::optional<Status> status = {};
  std::optional<Navigator> navigator = {};
  std::optional<Tracker> tracker = {};
  std::optional<Mission> mission = {};
  std::vector<Report> reports = {};
  std::optional<Flown> flown = {};
  std::shared_ptr<const VoxelGrid> map = {};
  double map_age_s = 0.0;  // of the newest map or update
};

}  // namespace goshawk::why
