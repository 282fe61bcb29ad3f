#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include "goshawk/core/certificate.hpp"
#include "goshawk/core/polytope.hpp"
#include "goshawk/core/trajectory.hpp"
#include "goshawk_msgs.h"

/// Messages to core types and back. from_msg takes what anyone may have sent: it returns a Result
/// if a message can be wrong; to_msg takes our own values and cannot fail.
namespace goshawk::conversions {

inline constexpr std::string_view kMapFrame = "map";
inline constexpr std::string_view kBodyFrame = "base_link";

builtin_interfaces::msg::Time to_stamp(std::int64_t time_ns);
std::int64_t to_ns(const builtin_interfaces::msg::Time& stamp);
std_msgs::msg::Header make_header(std::int64_t stamp_ns, std::string_view frame = kMapFrame);

/// @return wrong_frame unless the header names that frame. @param what for the sentence
Status check_frame(const std_msgs::msg::Header& header, std::string_view frame,
                   std::string_view what);

Vec3 from_msg(const geometry_msgs::msg::Point& m);
Vec3 from_msg(const geometry_msgs::msg::Vector3& m);
geometry_msgs::msg::Point to_point(const Vec3& v);
geometry_msgs::msg::Vector3 to_vector(const Vec3& v);
std::vector<Vec3> from_msg(const std::vector<geometry_msgs::msg::Point>& points);
std::vector<geometry_msgs::msg::Point> to_points(const std::vector<Vec3>& points);

FlatState from_msg(const goshawk_msgs::msg::FlatState& m);
goshawk_msgs::msg::FlatState to_msg(const FlatState& s);

/// @return invalid_input if sizes disagree; the numbers are not checked (Polytope::check())
Result<Polytope> from_msg(const goshawk_msgs::msg::Polytope& m);
goshawk_msgs::msg::Polytope to_msg(const Polytope& p);
Result<std::vector<Polytope>> from_msg(const std::vector<goshawk_msgs::msg::Polytope>& m);
std::vector<goshawk_msgs::msg::Polytope> to_msg(const std::vector<Polytope>& polytopes);

/// The numbers are not checked: certify() does.
Trajectory from_msg(const std::vector<goshawk_msgs::msg::BezierPiece>& m);
std::vector<goshawk_msgs::msg::BezierPiece> to_msg(const Trajectory& t);

goshawk_msgs::msg::Certificate to_msg(const Certificate& c);

}  // namespace goshawk::conversions
