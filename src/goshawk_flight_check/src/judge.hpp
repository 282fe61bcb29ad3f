#pragma once

#include <functional>
#include <span>
#include <vector>

#include "clearance.hpp"
#include "goshawk/flight_check/flight_check.hpp"

namespace goshawk::flight_check {

/// The motion through a track's samples: straight, evenly, along the shortest turns. A place on it
/// is a real number: 2.25 is a quarter of the way from sample 2 to sample 3.
class Motion {
 public:
  /// @param reach_m of the body @param drift_m_s how fast points of what it flies beside move, at
  /// most @pre at least one sample; times in order
  Motion(std::span<const Sample> track, double reach_m, double drift_m_s = 0.0);

  double end() const { return double(track_.size() - 1); }
  Pose pose(double place) const;
  double t_s(double place) const;

  /// [m] no point of the body moves farther than this from one place to a later one, as seen from
  /// any point of what it flies beside
  double moved_m(double from, double to) const { return moved_m(to) - moved_m(from); }

  /// @return a place strictly between two others, about as far from both: a sample if there is one
  double between(double from, double to) const;

 private:
  struct Step {
    std::size_t sample;
    double part;  // of the way to the next sample
  };
  Step step(double place) const;
  double moved_m(double place) const;

  std::span<const Sample> track_;
  std::vector<double> moved_m_;  // up to each sample
};

/// Finds the smallest clearance on a track, and the first contact, with as few measurements as the
/// question allows: what lies between two measured places is measured only if the bound
/// (c0 + c1 - L) / 2 leaves room for something that matters.
class Judge {
 public:
  /// The clearance of the body at a pose and a time [s], known not to be above a bound [m].
  using Measure = std::function<Clearance(const Pose& pose, double t_s, double at_most_m)>;

  /// @param below_m [m] clearances that are not below this do not matter
  Judge(Measure measure, const Motion& motion, double tolerance_m, double below_m);

  Verdict run();

 private:
  struct Measured {
    double place = 0.0;
    Clearance clearance;
    double distance_m() const { return clearance.distance_m; }
  };

  Measured measure(double place, double at_most_m);
  void search(const Measured& a, const Measured& b);
  double smallest_that_matters_m() const;
  void record_contact(const Measured& at);

  Measure measure_;
  const Motion& motion_;
  double tolerance_m_;
  double below_m_;
  Verdict verdict_;
};

}  // namespace goshawk::flight_check
