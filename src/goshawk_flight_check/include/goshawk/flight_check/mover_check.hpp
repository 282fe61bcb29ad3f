#pragma once

#include <cstdint>
#include <limits>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "goshawk/flight_check/flight_check.hpp"
#include "goshawk/movers/mover.hpp"

namespace goshawk::flight_check {

/// The second opinion on a flight among things that move, apart from that on the map.
struct MoverVerdict {
  std::vector<std::uint64_t> touched{};  // ids of the movers that the body touched, each once
  /// [m] smallest distance between body and movers, at most Options::tolerance_m above the true
  /// one; 0 if one was touched, infinity if nothing moves
  double clearance_m = std::numeric_limits<double>::infinity();
  double clearance_t_s = 0.0;               // [s] when; the first contact if one was touched
  Vec3 clearance_place_map = Vec3::Zero();  // [m] the nearest point of the mover
  std::string mover{};                      // "mover 3 (person)": whose clearance it is

  /// For people.
  std::string sentence() const;
  /// Takes in a verdict on a later part of the same flight.
  void add(const MoverVerdict& later);
};

/// The vehicle's true body against the boxes that move, continuous in time: as FlightCheck, with
/// the movers' largest speed added to the body's way, so that no contact is passed over.
class MoverCheck {
 public:
  /// @param start_s time of the samples at which the movers' time is 0
  /// @return invalid_parameter for body, options, or a start that is not finite
  static Result<MoverCheck> create(std::vector<movers::Mover> movers, double start_s,
                                   const Body& body = {}, const Options& options = {});

  /// @param track in the order of time; one sample is a vehicle that does not move
  /// @return invalid_input as FlightCheck::judge()
  Result<MoverVerdict> judge(std::span<const Sample> track) const;

  MoverCheck(MoverCheck&&) noexcept;
  MoverCheck& operator=(MoverCheck&&) noexcept;
  ~MoverCheck();

 private:
  class Implementation;
  explicit MoverCheck(std::unique_ptr<Implementation> implementation);
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace goshawk::flight_check
