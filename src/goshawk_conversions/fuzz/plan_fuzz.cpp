// Planning messages whose bytes were changed at will, and any bytes as such messages: refused with a
// sentence, or a domain type that keeps its promise. The first byte chooses the message; each three
// bytes after it write one byte of the encoded message.
#include <fastcdr/Cdr.h>
#include <fastcdr/FastBuffer.h>
#include <fastcdr/exceptions/Exception.h>

#include <vector>

#include "goshawk/conversions/plan.hpp"
#include "goshawk/conversions/vehicle.hpp"

namespace {

using namespace goshawk;
namespace cdr = eprosima::fastcdr;
namespace msg = goshawk_msgs::msg;
using Bytes = std::vector<char>;

void expect(bool holds) {
  if (!holds) __builtin_trap();
}

template <typename Message>
Bytes encode(const Message& m) {
  cdr::FastBuffer buffer;
  cdr::Cdr out(buffer, cdr::Cdr::DEFAULT_ENDIAN, cdr::Cdr::DDS_CDR);
  out.serialize_encapsulation();
  m.serialize(out);
  return {buffer.getBuffer(), buffer.getBuffer() + out.getSerializedDataLength()};
}

template <typename Message>
bool decode(Bytes bytes, Message& m) {
  cdr::FastBuffer buffer(bytes.data(), bytes.size());
  cdr::Cdr in(buffer, cdr::Cdr::DEFAULT_ENDIAN, cdr::Cdr::DDS_CDR);
  try {
    in.read_encapsulation();
    m.deserialize(in);
    return true;
  } catch (const cdr::exception::Exception&) {
    return false;
  } catch (const std::bad_alloc&) {
    return false;  // the payload check stands before this in the stack
  } catch (const std::length_error&) {
    return false;
  }
}

msg::BezierTrajectory good_trajectory() {
  PlanRequest request;
  request.id = 12;
  request.goal.position = Vec3(1, 0, 0);
  msg::BezierTrajectory m;
  m.header(conversions::make_header(0));
  m.request(conversions::to_msg(request));
  m.pieces(conversions::to_msg(Trajectory{{BezierPiece::between(request.start, request.goal, 8)}}));
  m.polytopes(conversions::to_msg(std::vector{Polytope::box(Vec3(-1, -1, -1), Vec3(3, 1, 1))}));
  return m;
}

msg::CommittedTrajectory good_commit() {
  msg::CommittedTrajectory m;
  m.header(conversions::make_header(0));
  m.nominal(good_trajectory());
  const auto nominal = conversions::from_msg(m.nominal()).value();
  FlatState from = nominal.trajectory().sample(4.0);
  from.jerk.setZero();
  FlatState to;
  to.position = from.position + from.velocity;
  m.stop_after(4.0);
  m.stop_pieces(conversions::to_msg(Trajectory{{BezierPiece::between(from, to, 2.0)}}));
  m.stop_polytopes(m.nominal().polytopes());
  expect(conversions::from_msg(m).ok());
  return m;
}

msg::Corridor good_corridor() {
  msg::Corridor m;
  m.header(conversions::make_header(0));
  m.waypoints(conversions::to_points({Vec3(0.5, 0.5, 0.5), Vec3(1.5, 0.5, 0.5)}));
  m.polytopes(conversions::to_msg(std::vector{Polytope::box(Vec3(0, 0, 0), Vec3(2, 1, 1))}));
  return m;
}

msg::Path good_path() {
  msg::Path m;
  m.header(conversions::make_header(0));
  m.waypoints(conversions::to_points({Vec3(1, 2, 3), Vec3(4, 5, 6)}));
  return m;
}

nav_msgs::msg::Odometry good_odometry() {
  nav_msgs::msg::Odometry m;
  m.header(conversions::make_header(0));
  conversions::fill_msg(RigidBodyState{}, m);
  return m;
}

void promise(const PlanRequest& r) {
  expect(goshawk::check(r).ok());
}
void promise(const std::vector<Vec3>& waypoints) {
  expect(waypoints.size() >= 2);
  for (const Vec3& p : waypoints) expect(p.allFinite());
}
void promise(const Corridor& c) {
  (void)c.check();
}
void promise(const CertifiedTrajectory& t) {
  expect(t.certificate().holds());
  expect(t.trajectory().sample(0.5 * t.trajectory().duration_s()).is_finite());
}
void promise(const CommittedTrajectory& c) {
  promise(c.nominal());
  if (c.stop()) promise(c.stop()->trajectory);
  const Trajectory flown = c.flown();
  const FlatState end = flown.sample(flown.duration_s());
  expect(end.is_finite() && end.velocity.norm() < 1e-2);
}
void promise(const RigidBodyState& s) {
  expect(s.is_finite());
}

template <typename Message, typename Convert>
void check(const Message& good, const Convert& convert, const std::uint8_t* data,
           std::size_t size) {
  const auto judge = [&](const Message& m) {
    const auto result = convert(m);
    if (result) return promise(*result);
    expect(!result.error().message.empty());
  };
  Bytes bytes = encode(good);
  for (std::size_t k = 0; k + 3 <= size; k += 3) {
    bytes[(data[k] + 256U * data[k + 1]) % bytes.size()] = char(data[k + 2]);
  }
  Message m;
  if (decode(bytes, m)) judge(m);
  Message any;
  if (decode({data, data + size}, any)) judge(any);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  static const msg::BezierTrajectory trajectory = good_trajectory();
  static const msg::CommittedTrajectory commit = good_commit();
  static const msg::Corridor corridor = good_corridor();
  static const msg::Path path = good_path();
  static const nav_msgs::msg::Odometry odometry = good_odometry();
  const auto convert = [](const auto& m) { return conversions::from_msg(m); };
  const std::uint8_t* at = data + 1;
  const std::size_t left = size - 1;
  switch (data[0] % 6) {
    case 0: check(trajectory.request(), convert, at, left); break;
    case 1: check(path, conversions::waypoints_of, at, left); break;
    case 2: check(corridor, convert, at, left); break;
    case 3: check(trajectory, convert, at, left); break;
    case 4: check(commit, convert, at, left); break;
    default: check(odometry, convert, at, left);
  }
  return 0;
}
