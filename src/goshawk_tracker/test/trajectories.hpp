#pragma once

#include "goshawk/core/random.hpp"
#include "goshawk/tracker/committed_trajectory.hpp"

namespace goshawk::tracker {

/// A certified C2 trajectory of quintics through random points, at rest at both ends, whose curve
/// (not only its hull) reaches v_max or a_max. @param start where it begins
CommittedTrajectory random_trajectory(Random& random, const Vec3& start, int pieces,
                                      double v_max_m_s, double a_max_m_s2);

/// Start to end in one quintic from rest to rest, certified inside a large box.
CommittedTrajectory straight_line(const Vec3& start, const Vec3& end, double duration_s);

/// The limits that its own hull keeps, and the start and goal it has: so that it certifies.
void certify_as_is(CommittedTrajectory& committed);

}  // namespace goshawk::tracker
