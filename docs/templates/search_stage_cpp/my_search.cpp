// A search stage of your own: breadth first over the six face neighbours. Replace search().
#include <signal.h>

#include <algorithm>
#include <functional>

#include "goshawk/stage/intake.hpp"
#include "goshawk/stage/map_subscription.hpp"

using namespace goshawk;
using namespace goshawk::runtime;
using namespace goshawk::stage;
namespace msg = goshawk_msgs::msg;

// From start to goal through centres of free voxels; the way turns at each point between.
Result<std::vector<Vec3>> search(const VoxelGrid& grid, const Vec3& start, const Vec3& goal) {
  const auto from = locate(grid, start, Endpoint::start);  // start_outside, start_occupied, ...
  if (!from) return from.error();
  const auto to = locate(grid, goal, Endpoint::goal);
  if (!to) return to.error();
  const Index3 n = grid.geometry.size;
  const auto index = [&](Index3 i) { return (std::size_t(i.z) * n.y + i.y) * n.x + i.x; };
  std::vector<int> step_to(std::size_t(n.x) * n.y * n.z, -1);  // by which step it was reached
  const Index3 steps[] = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
  std::vector<Index3> queue{*to};  // from the goal, so that the way back is the path
  step_to[index(*to)] = 6;
  for (std::size_t head = 0; head < queue.size() && step_to[index(*from)] < 0; ++head) {
    const Index3 i = queue[head];
    for (int k = 0; k < 6; ++k) {
      const Index3 next{i.x + steps[k].x, i.y + steps[k].y, i.z + steps[k].z};
      if (grid.grown.test(next) || step_to[index(next)] >= 0) continue;
      step_to[index(next)] = k;
      queue.push_back(next);
    }
  }
  if (step_to[index(*from)] < 0) {
    return fail(ErrorCode::no_path, "the goal is cut off from the start");
  }
  std::vector<Vec3> points{start};
  int before = -1;
  Index3 i = *from;
  for (int k = step_to[index(i)]; k < 6; k = step_to[index(i)]) {
    if (k != before) points.push_back(grid.geometry.center(i));
    before = k;
    i = {i.x - steps[k].x, i.y - steps[k].y, i.z - steps[k].z};
  }
  points.push_back(grid.geometry.center(i));
  points.push_back(goal);
  return points;
}

class MySearch {
 public:
  explicit MySearch(Node& node)
      : node_(node),
        reporter_(node, StageRole::path_search, "my_search"),
        publisher_(node.advertise<msg::Path>("path", Qos::reliable_last())),
        map_(node, reporter_),
        requests_(node, reporter_, "plan_request", std::bind_front(&MySearch::on, this)) {
    reporter_.ready("searches breadth first");
  }

 private:
  // A request that is valid, in time and not superseded.
  void on(const msg::PlanRequest& m, const PlanRequest& request, Timing timing) {
    if (map_.grid() == nullptr) {
      return reporter_.failed(m.id(), fail(ErrorCode::no_map, "no map has come yet"), timing);
    }
    const auto [path, compute_ns] = timed(
        [&] { return search(*map_.grid(), request.start.position, request.goal.position); });
    timing.compute_ns = compute_ns;
    if (!path) return reporter_.failed(m.id(), path.error(), timing);
    msg::Path answer;
    answer.header(conversions::make_header(node_.now_ns()));
    answer.request(m);  // whole, as it came
    answer.implementation("my_search");
    answer.map_version(map_.grid()->version);
    answer.raw(conversions::to_points(*path));
    answer.waypoints(conversions::to_points(*path));
    answer.compute_ns(compute_ns);
    reporter_.send(publisher_, answer, m.id());
    reporter_.answered(m.id(), timing);
  }

  Node& node_;
  StageReporter reporter_;
  Publisher<msg::Path> publisher_;
  MapSubscription map_;
  Intake<msg::PlanRequest> requests_;
};

int main(int argc, char** argv) {
  std::vector<std::string> arguments(argv + 1, argv + argc);
  const auto args = RosArgs::extract(arguments);  // --ros-args -r __ns:=/uav1
  auto options = ContextOptions::from_environment();
  if (!args || !options) return 2;
  options->node_names = {"/path_search"};
  auto context = Context::create(*options);
  if (!context) return 2;
  Node node(**context, "path_search", *args);
  const MySearch stage(node);
  static volatile sig_atomic_t stopped = 0;
  for (const int signal_number : {SIGINT, SIGTERM}) signal(signal_number, [](int) { stopped = 1; });
  while (stopped == 0) node.spin_some(0.1);
  return 0;
}
