#pragma once

#include "goshawk/closed_loop/flight_lab.hpp"
#include "goshawk/closed_loop/live_mapper.hpp"
#include "goshawk/league/scene.hpp"

namespace goshawk::league {

/// How a scene is flown.
struct Options {
  closed_loop::Setup vehicle = {};  // the vehicle and its stages; limits and start are the scene's
  closed_loop::Tracking tracking = closed_loop::Tracking::physical;
  bool known = false;                   // the vehicle has the whole map from the beginning
  double range_noise_m = 0.0;           // of the lidar, one sigma
  double range_m = 30.0;                // of the lidar
  double view_rad = 6.283185307179586;  // of the lidar, around the vehicle's x axis
  std::uint64_t seed = 0;               // of noise and delays
  /// [s] what each planning stage and each scan is taken to cost; nothing: what they cost, measured
  std::optional<double> latency_s = {};
};

/// One moment of a flight.
struct Moment {
  double t_s = 0.0;  // since the goal was given
  RigidBodyState vehicle;
  FlatState reference;
};

/// What came of a flight.
struct Outcome {
  bool arrived = false;
  std::string reason = {};  // why not
  ErrorCode code = ErrorCode::ok;
  double time_s = 0.0;    // from the goal until it was at rest there, or was given up
  double length_m = 0.0;  // flown
  double top_speed_m_s = 0.0;
  flight_check::Verdict verdict;  // against the true world
  int violations = 0;        // samples of the reference (250 Hz) beyond a limit by more than 1e-3
  double worst_use = 0.0;    // of a limit by the reference; 1 at the limit
  double jerk_m_s2 = 0.0;    // integral of the reference's jerk
  double max_error_m = 0.0;  // of the tracking
  int plans = 0;
  int failed_plans = 0;
  int commits = 0;
  int stops = 0;  // how often it came to rest before the goal
  std::vector<closed_loop::Replan> replans = {};
  std::vector<double> scan_s = {};  // what each scan took to be in the map
  std::vector<Moment> track = {};   // 250 Hz
  /// What went wrong on the way, each with its time: trajectories lost or refused by the tracker,
  /// plans that failed, what the navigator says when it plans again.
  std::vector<std::string> events = {};
};

/// Flies a scene, and has the flight judged. @return what of the configuration cannot be
Result<Outcome> fly(const Scene& scene, const Options& options);

/// The lidar of the league: 64 x 512 rays over 360 by 90 degrees, 10 Hz, 30 m, at the body's
/// centre; with the options' noise, range and view.
sensors::SensorParameters league_lidar(const Options& options);

/// What plans keep from obstacles: body, margin and reserve [m].
double plan_clearance_m();

}  // namespace goshawk::league
