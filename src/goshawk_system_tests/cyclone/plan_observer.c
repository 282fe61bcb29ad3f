// plan_observer x y z: publishes a goal, receives path, corridor and trajectory, and checks the
// certificate by itself. Uses idl/ and nothing else of Goshawk.
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "goshawk_dds.h"
#include "goshawk_msgs.h"

typedef geometry_msgs_msg_Point Point;
typedef goshawk_msgs_msg_BezierPiece Piece;
typedef goshawk_msgs_msg_BezierTrajectory Trajectory;

static double component(Point p, int axis) { return axis == 0 ? p.x : axis == 1 ? p.y : p.z; }

// [m] how far a point is outside the polytope {p : A p <= b}; negative inside.
static double outside(const goshawk_msgs_msg_Polytope* polytope, Point p) {
  double worst = -INFINITY;
  for (uint32_t i = 0; i < polytope->offsets._length; ++i) {
    const double* n = polytope->normals._buffer + 3 * i;
    worst = fmax(worst, n[0] * p.x + n[1] * p.y + n[2] * p.z - polytope->offsets._buffer[i]);
  }
  return worst;
}

// k-th difference of the control points from j on: 1 for velocity, 2 for acceleration.
static double derivative(const Piece* piece, int k, int j, int axis) {
  const Point* c = piece->control_points;
  const double T = piece->duration;
  const double d1 = component(c[j + 1], axis) - component(c[j], axis);
  if (k == 1) return 5.0 / T * d1;
  const double d2 = component(c[j + 2], axis) - component(c[j + 1], axis);
  return 20.0 / (T * T) * (d2 - d1);
}

static double length(const Piece* piece, int k, int j) {
  double squares = 0.0;
  for (int axis = 0; axis < 3; ++axis) squares += pow(derivative(piece, k, j, axis), 2);
  return sqrt(squares);
}

static double gap(const Piece* before, const Piece* after) {
  double worst = 0.0;
  for (int axis = 0; axis < 3; ++axis) {
    worst = fmax(worst, fabs(component(before->control_points[5], axis) -
                             component(after->control_points[0], axis)));
    worst = fmax(worst, fabs(derivative(before, 1, 4, axis) - derivative(after, 1, 0, axis)));
    worst = fmax(worst, fabs(derivative(before, 2, 3, axis) - derivative(after, 2, 0, axis)));
  }
  return worst;
}

static double distance(Point a, Point b) {
  return sqrt(pow(a.x - b.x, 2) + pow(a.y - b.y, 2) + pow(a.z - b.z, 2));
}

// The largest violation of anything; at most 0 up to rounding for a certified trajectory.
static double largest_violation(const Trajectory* t) {
  double worst = -INFINITY;
  const uint32_t pieces = t->pieces._length;
  for (uint32_t k = 0; k < pieces; ++k) {
    const Piece* piece = &t->pieces._buffer[k];
    for (int j = 0; j < 6; ++j) {
      worst = fmax(worst, outside(&t->polytopes._buffer[piece->polytope],
                                  piece->control_points[j]));
    }
    for (int j = 0; j < 5; ++j) {
      worst = fmax(worst, length(piece, 1, j) - t->request.limits.v_max);
    }
    for (int j = 0; j < 4; ++j) {
      worst = fmax(worst, length(piece, 2, j) - t->request.limits.a_max);
    }
    if (k > 0) worst = fmax(worst, gap(piece - 1, piece));
  }
  worst = fmax(worst, distance(t->pieces._buffer[0].control_points[0], t->request.start.position));
  return fmax(worst, distance(t->pieces._buffer[pieces - 1].control_points[5],
                              t->request.goal.position));
}

static bool all_found(dds_entity_t writer, const dds_entity_t* readers, int count) {
  dds_publication_matched_status_t read = {0};
  dds_get_publication_matched_status(writer, &read);
  bool found = read.current_count > 0;
  for (int i = 0; i < count; ++i) {
    dds_subscription_matched_status_t written = {0};
    dds_get_subscription_matched_status(readers[i], &written);
    found = found && written.current_count > 0;
  }
  return found;
}

static void drop_old(dds_entity_t reader) {
  void* sample = goshawk_take(reader, 0.0);
  for (; sample != NULL; sample = goshawk_take(reader, 0.0)) dds_return_loan(reader, &sample, 1);
}

int main(int argc, char** argv) {
  if (argc != 4) {
    fprintf(stderr, "usage: plan_observer x y z\n");
    return 2;
  }
  const char* domain = getenv("ROS_DOMAIN_ID");
  const dds_entity_t dp =
      dds_create_participant(domain ? (dds_domainid_t)atoi(domain) : 0, NULL, NULL);
  const dds_entity_t goals = goshawk_writer(
      dp, goshawk_topic(dp, &geometry_msgs_msg_PoseStamped_desc,
                        "geometry_msgs::msg::dds_::PoseStamped_", "rt/goal_pose"), 1, false);
  const dds_entity_t paths = goshawk_reader(
      dp, goshawk_topic(dp, &goshawk_msgs_msg_Path_desc, "goshawk_msgs::msg::dds_::Path_",
                        "rt/path"), 10, false);
  const dds_entity_t corridors = goshawk_reader(
      dp, goshawk_topic(dp, &goshawk_msgs_msg_Corridor_desc,
                        "goshawk_msgs::msg::dds_::Corridor_", "rt/corridor"), 10, false);
  const dds_entity_t trajectories = goshawk_reader(
      dp, goshawk_topic(dp, &goshawk_msgs_msg_BezierTrajectory_desc,
                        "goshawk_msgs::msg::dds_::BezierTrajectory_", "rt/trajectory"), 10, false);

  // Discovery: until the navigator reads goals and every stage writes to us, and a moment for them
  // to find us as well.
  const dds_entity_t answers[] = {paths, corridors, trajectories};
  for (int i = 0; i < 1500 && !all_found(goals, answers, 3); ++i) dds_sleepfor(DDS_MSECS(20));
  dds_sleepfor(DDS_SECS(1));

  geometry_msgs_msg_PoseStamped goal = {0};
  goal.header.frame_id = "map";
  goal.pose.position = (Point){atof(argv[1]), atof(argv[2]), atof(argv[3])};
  goal.pose.orientation.w = 1.0;

  // A stage may not have found us yet: the goal is sent again until all three answer it.
  goshawk_msgs_msg_Path* path = NULL;
  goshawk_msgs_msg_Corridor* corridor = NULL;
  Trajectory* trajectory = NULL;
  for (int attempt = 0; attempt < 5 && trajectory == NULL; ++attempt) {
    for (int i = 0; i < 3; ++i) drop_old(answers[i]);
    if (dds_write(goals, &goal) != DDS_RETCODE_OK) return 1;
    path = goshawk_take(paths, 10.0);
    corridor = path ? goshawk_take(corridors, 10.0) : NULL;
    trajectory = corridor ? goshawk_take(trajectories, 10.0) : NULL;
  }
  if (path == NULL || corridor == NULL || trajectory == NULL) {
    fprintf(stderr, "no answer: path %d, corridor %d, trajectory %d\n", path != NULL,
            corridor != NULL, trajectory != NULL);
    return 1;
  }
  const double violation = largest_violation(trajectory);
  printf("{\"request\": %llu, \"waypoints\": %u, \"polytopes\": %u, \"pieces\": %u, "
         "\"largest_violation\": %.3g}\n",
         (unsigned long long)trajectory->request.id, corridor->waypoints._length,
         corridor->polytopes._length, trajectory->pieces._length, violation);
  const bool same = path->request.id == corridor->request.id &&
                    corridor->request.id == trajectory->request.id &&
                    distance(trajectory->request.goal.position, goal.pose.position) < 1e-9;
  dds_delete(dp);
  return same && violation <= 1e-6 ? 0 : 1;
}
