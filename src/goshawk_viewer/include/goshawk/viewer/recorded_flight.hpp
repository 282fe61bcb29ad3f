#pragma once

#include <functional>
#include <map>
#include <optional>

#include "goshawk/core/grid_geometry.hpp"
#include "goshawk/flight_report/flight.hpp"
#include "goshawk/flight_report/map_timeline.hpp"
#include "goshawk/recording/reader.hpp"

namespace goshawk::viewer {

/// What a page draws of a recording: the maps, how they grew, every committed trajectory with its
/// path, the goals, the track, and what moved. Of several vehicles, the one whose topic's name
/// comes first.
class RecordedFlight {
 public:
  /// @return io_failed if the file cannot be read; invalid_input if it holds nothing to draw
  static Result<RecordedFlight> read(recording::Reader& reader);

  /// On the clock of its first odometry. @return refers to the maps of this object
  flight_report::Flight flight(const std::string& title) const;

  /// How the map grew, and what moved: for a flight whose other parts are known.
  /// @param origin_ns when that flight's clock is 0
  void add_world(flight_report::Flight& flight, std::int64_t origin_ns) const;

  /// What could not be used, one sentence each.
  const std::vector<std::string>& complaints() const { return complaints_; }

 private:
  using Bytes = std::vector<unsigned char>;
  using Take = Status (RecordedFlight::*)(const Bytes&);
  struct State {
    std::int64_t stamp_ns = 0;
    flight_report::FlownSample sample;
  };

  static std::map<std::uint16_t, Take> choose(const recording::Reader& reader);
  bool is_empty() const {
    return !obstacles_ && !maps_.newest() && committed_.empty() && flown_.empty();
  }
  Status take_odometry(const Bytes& bytes);
  Status take_commitment(const Bytes& bytes);
  Status take_path(const Bytes& bytes);
  Status take_octomap(const Bytes& bytes);
  Status take_grown(const Bytes& bytes);
  Status take_update(const Bytes& bytes);
  Status take_navigator(const Bytes& bytes);
  Status take_movers(const Bytes& bytes);
  Status take_predictions(const Bytes& bytes);

  std::optional<VoxelGrid> obstacles_;
  flight_report::MapTimeline maps_;                  // times since 1970, as stamped
  std::vector<Vec3> goals_;                          // each once as long as it is the newest
  std::vector<flight_report::MoversMoment> movers_;  // times since 1970
  std::vector<flight_report::PredictionsMoment> predictions_;  // times since 1970
  std::map<std::uint64_t, flight_report::Leg> paths_;          // by their requests
  std::vector<CommittedTrajectory> committed_;
  std::vector<State> flown_;
  std::vector<std::string> complaints_;
};

}  // namespace goshawk::viewer
