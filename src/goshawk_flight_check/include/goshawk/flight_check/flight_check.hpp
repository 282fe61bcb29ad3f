#pragma once

#include <cstdint>
#include <filesystem>
#include <limits>
#include <memory>
#include <span>
#include <string>
#include <string_view>

#include "goshawk/core/result.hpp"
#include "goshawk/core/vehicle.hpp"
#include "goshawk/flight_check/body.hpp"
#include "goshawk/flight_check/solid.hpp"

namespace octomap {
class OcTree;
}

namespace goshawk::flight_check {

/// Where the vehicle was at one moment. Between two samples the position is taken to move along
/// the straight line and the attitude along the shortest turn, both evenly; a vehicle whose
/// acceleration stays below a strays from that line by at most a dt^2 / 8 (0.1 mm at 100 Hz and
/// 8 m/s^2): sample densely enough for the clearance you need.
struct Sample {
  double t_s = 0.0;                                // [s]
  Vec3 position_map = Vec3::Zero();                // [m] of base_link
  Quaternion q_map_base = Quaternion::Identity();  // base_link to map
};

/// What lies in a long gap between samples of a flown track is not known, so it cannot be judged.
inline constexpr double kLongestGap_s = 0.5;

/// @return tracking_lost, naming the longest gap, if it is above kLongestGap_s
Status check_gaps(std::span<const Sample> track);

struct Verdict {
  bool touched = false;
  /// [m] smallest distance between body and obstacles, at most Options::tolerance_m above the
  /// true one; 0 if touched, infinity if the map has no obstacle
  double clearance_m = 0.0;
  double clearance_t_s = 0.0;  // [s] when; the first contact if touched
  /// [m] where: the nearest point of an obstacle; the contact if touched; the vehicle's own
  /// position if the map has no obstacle
  Vec3 clearance_place_map = Vec3::Zero();
  std::int64_t samples = 0;  // how many samples were judged
  std::int64_t queries = 0;  // how many poses were measured
  std::string sentence{};    // the verdict for people
};

struct Options {
  bool count_unknown_as_obstacle = false;  // also everything outside of the map
  double tolerance_m = 1e-3;               // [m] how exactly the smallest clearance is found
};

/// The second opinion on a flight: the vehicle's true body against the raw OctoMap, measured by
/// FCL (Pan, Chitta, Manocha: FCL, a general purpose library for collision and proximity queries,
/// ICRA 2012). It uses nothing of the planner: no inflated grid, no corridor, no line of sight.
///
/// It leaves no gap: a body whose points all move by at most L between two poses with clearances c0
/// and c1 stays (c0 + c1 - L) / 2 away from everything in between. A part of the flight for which
/// that bound is not good enough is halved until it is, so that far from obstacles most samples
/// need no measurement (conservative advancement from both ends; Mirtich, 1996). L is the distance
/// flown plus the angle turned times Body::reach_m().
class FlightCheck {
 public:
  /// @param map_file an OctoMap file, .bt or .ot
  /// @return map_unreadable, map_malformed, map_empty, or invalid_parameter for body and options
  static Result<FlightCheck> open(const std::filesystem::path& map_file, const Body& body = {},
                                  const Options& options = {});

  /// Takes the tree over, since inner nodes have to be brought up to date first.
  /// @return map_empty for no tree or no node; invalid_parameter
  static Result<FlightCheck> from_tree(std::unique_ptr<octomap::OcTree> tree, const Body& body = {},
                                       const Options& options = {});

  /// @param payload of an octomap_msgs/Octomap message with `binary` set
  /// @return map_malformed, map_empty or invalid_parameter
  static Result<FlightCheck> from_payload(std::string_view payload, double resolution_m,
                                          const Body& body = {}, const Options& options = {});

  /// Against the solids of a world as they are, without voxels.
  /// @return map_empty for no solid; invalid_input for one that cannot be; invalid_parameter
  static Result<FlightCheck> from_solids(std::span<const Solid> solids, const Body& body = {},
                                         const Options& options = {});

  /// @param track in the order of time; one sample is a vehicle that does not move
  /// @param below_m [m] clearances that are not below this need not be found: the verdict's
  /// clearance may then be too large, but a contact is always found
  /// @return invalid_input for no sample, a number that is not finite, a position beyond 1e6 m,
  /// a quaternion without unit length, or time that goes backwards; names the sample
  Result<Verdict> judge(std::span<const Sample> track,
                        double below_m = std::numeric_limits<double>::infinity()) const;

  FlightCheck(FlightCheck&&) noexcept;
  FlightCheck& operator=(FlightCheck&&) noexcept;
  ~FlightCheck();

 private:
  class Implementation;
  explicit FlightCheck(std::unique_ptr<Implementation> implementation);
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace goshawk::flight_check
