// goshawk_lock_step_pilot END_S: node `pilot` of a flight in lock step. It sends goals and clouds
// at simulated times of its own, so that the flight repeats bit for bit, and ends at END_S.

#include <cstdio>
#include <cstdlib>
#include <cstring>

#include "geometry_msgs.h"
#include "goshawk/conversions/geometry.hpp"
#include "goshawk/runtime/node.hpp"
#include "sensor_msgs.h"

namespace {

using namespace goshawk;
using runtime::Qos;

struct Goal {
  double at_s;
  Vec3 place;
};

// The second comes in flight, the third cannot be reached: it is outside of the map.
const Goal kGoals[] = {{2.0, {3.0, 8.0, 2.0}},
                       {4.0, {3.5, 6.1, 1.1}},
                       {5.0, {90.0, 0.0, 1.0}},
                       {6.0, {3.0, 4.0, 1.5}}};

/// A patch of wall, 0.5 m x 0.5 m, that grows along x with every cloud.
sensor_msgs::msg::PointCloud2 patch(std::int64_t now_ns, int number) {
  constexpr int kSide = 6;
  sensor_msgs::msg::PointCloud2 m;
  m.header(conversions::make_header(now_ns));
  m.height(1);
  m.width(kSide * kSide);
  m.point_step(12);
  m.row_step(12 * kSide * kSide);
  m.is_dense(true);
  for (std::uint32_t axis = 0; axis < 3; ++axis) {
    sensor_msgs::msg::PointField field;
    field.name(std::string(1, "xyz"[axis]));
    field.offset(4 * axis);
    field.datatype(7);  // float32
    field.count(1);
    m.fields().push_back(field);
  }
  for (int i = 0; i < kSide; ++i) {
    for (int j = 0; j < kSide; ++j) {
      const float point[] = {0.5F + 0.1F * float(i + number), 3.05F, 0.5F + 0.1F * float(j)};
      unsigned char bytes[sizeof point];
      std::memcpy(bytes, point, sizeof point);
      m.data().insert(m.data().end(), bytes, bytes + sizeof point);
    }
  }
  return m;
}

class Pilot {
 public:
  explicit Pilot(runtime::Node& node) : node_(node) {
    node.run_in_lock_step();
    goals_ = node.advertise<geometry_msgs::msg::PoseStamped>("goal_pose", Qos::reliable_last());
    clouds_ = node.advertise<sensor_msgs::msg::PointCloud2>("cloud_in", Qos::best_effort(2));
    node.every(0.05, [this] { send_goals(); });
    node.every(0.5, [this] { (void)clouds_.publish(patch(node_.now_ns(), cloud_++)); });
  }

 private:
  void send_goals() {
    const double now_s = double(node_.now_ns()) * 1e-9;
    if (goal_ == std::size(kGoals) || now_s < kGoals[goal_].at_s) return;
    geometry_msgs::msg::PoseStamped m;
    m.header(conversions::make_header(node_.now_ns()));
    m.pose().position(conversions::to_point(kGoals[goal_++].place));
    m.pose().orientation().w(1.0);
    (void)goals_.publish(m);
  }

  runtime::Node& node_;
  runtime::Publisher<geometry_msgs::msg::PoseStamped> goals_;
  runtime::Publisher<sensor_msgs::msg::PointCloud2> clouds_;
  std::size_t goal_ = 0;
  int cloud_ = 0;
};

}  // namespace

int main(int argc, char** argv) {
  const double end_s = argc == 2 ? std::atof(argv[1]) : 0.0;
  if (!(end_s > 0.0)) {
    std::fprintf(stderr, "usage: goshawk_lock_step_pilot END_S\n");
    return 2;
  }
  const auto options = runtime::ContextOptions::from_environment();
  auto context = options ? runtime::Context::create(*options) : options.error();
  if (!context) {
    std::fprintf(stderr, "goshawk_lock_step_pilot: %s\n", context.error().message.c_str());
    return 1;
  }
  runtime::Node node(**context, "pilot");
  const Pilot pilot(node);
  while (double(node.now_ns()) * 1e-9 < end_s) node.spin_some(0.1);
  return 0;
}
