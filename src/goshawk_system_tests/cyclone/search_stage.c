// A search stage in C, from idl/ alone: breadth first over the six face neighbours. Slow and
// simple; the rest of the stack takes its paths as it takes ours. Runs until it is stopped.
#include <math.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "goshawk_dds.h"
#include "goshawk_msgs.h"

typedef goshawk_msgs_msg_VoxelGrid Grid;
typedef goshawk_msgs_msg_PlanRequest Request;
typedef geometry_msgs_msg_Point Point;

static volatile sig_atomic_t stopped = 0;
static void stop(int signal) {
  (void)signal;
  stopped = 1;
}

static long voxels(const Grid* g) { return (long)g->size_x * g->size_y * g->size_z; }

static bool blocked(const Grid* g, long x, long y, long z) {
  if (x < 0 || y < 0 || z < 0 || x >= g->size_x || y >= g->size_y || z >= g->size_z) return true;
  const long words = (g->size_x + 63) / 64;
  return (g->grown._buffer[(z * g->size_y + y) * words + x / 64] >> (x % 64)) & 1;
}

enum { OUTSIDE = -1, OCCUPIED = -2 };

// The voxel of a point, or OUTSIDE or OCCUPIED where the vehicle cannot be.
static long voxel_of(const Grid* g, Point p) {
  const double x = (p.x - g->origin.x) / g->resolution;
  const double y = (p.y - g->origin.y) / g->resolution;
  const double z = (p.z - g->origin.z) / g->resolution;
  if (!(x >= 0 && y >= 0 && z >= 0 && x < g->size_x && y < g->size_y && z < g->size_z)) return OUTSIDE;
  if (blocked(g, (long)x, (long)y, (long)z)) return OCCUPIED;
  return ((long)z * g->size_y + (long)y) * g->size_x + (long)x;
}

static Point center(const Grid* g, long i) {
  const long x = i % g->size_x, y = i / g->size_x % g->size_y, z = i / g->size_x / g->size_y;
  return (Point){g->origin.x + (x + 0.5) * g->resolution, g->origin.y + (y + 0.5) * g->resolution,
                 g->origin.z + (z + 0.5) * g->resolution};
}

// parent[i] of every voxel that was reached from `goal`; -1 else. @return whether start was.
static bool flood(const Grid* g, long start, long goal, long* parent, long* queue) {
  static const int step[6][3] = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
  for (long i = 0; i < voxels(g); ++i) parent[i] = -1;
  long head = 0, tail = 0;
  parent[goal] = goal;
  queue[tail++] = goal;
  while (head < tail && parent[start] < 0) {
    const long i = queue[head++];
    const long x = i % g->size_x, y = i / g->size_x % g->size_y, z = i / g->size_x / g->size_y;
    for (int k = 0; k < 6; ++k) {
      const long nx = x + step[k][0], ny = y + step[k][1], nz = z + step[k][2];
      if (blocked(g, nx, ny, nz)) continue;
      const long n = (nz * g->size_y + ny) * g->size_x + nx;
      if (parent[n] >= 0) continue;
      parent[n] = i;
      queue[tail++] = n;
    }
  }
  return parent[start] >= 0;
}

// Start, the voxels where the way turns, goal. @return how many
static uint32_t corners(const Grid* g, const Request* r, long start, long goal, const long* parent,
                        Point* out) {
  uint32_t count = 0;
  out[count++] = r->start.position;
  long before = 0;
  for (long i = start; i != goal; i = parent[i]) {
    const long move = parent[i] - i;
    if (move != before) out[count++] = center(g, i);
    before = move;
  }
  if (goal != start) out[count++] = center(g, goal);
  out[count++] = r->goal.position;
  return count;
}

static void report(dds_entity_t writer, const Request* r, const char* code, const char* message) {
  goshawk_msgs_msg_StageReport m = {0};
  m.header.frame_id = "map";
  m.stage = goshawk_msgs_msg_StageReport_Constants_STAGE_PATH_SEARCH;
  m.node = "/path_search";
  m.implementation = "cyclone_bfs";
  m.request_id = r != NULL ? r->id : 0;
  m.code = (char*)code;
  m.message = (char*)message;
  dds_write(writer, &m);
}

static bool finite_state(const goshawk_msgs_msg_FlatState* s) {
  const double all[9] = {s->position.x,     s->position.y,     s->position.z,
                         s->velocity.x,     s->velocity.y,     s->velocity.z,
                         s->acceleration.x, s->acceleration.y, s->acceleration.z};
  for (int k = 0; k < 9; ++k) {
    if (!isfinite(all[k])) return false;
  }
  return true;
}

// Refuses a bad request. @return whether it is good
static bool check(dds_entity_t reports, const Request* r, dds_time_t heard_ns) {
  const goshawk_msgs_msg_Limits* l = &r->limits;
  const double waited_s = 1e-9 * (double)(dds_time() - heard_ns);
  const char *code = "ok", *message = "";
  if (strcmp(r->header.frame_id, "map") != 0) {
    code = "wrong_frame", message = "the request must be in frame map";
  } else if (!finite_state(&r->start) || !finite_state(&r->goal) || !isfinite(r->goal_yaw) ||
             !isfinite(r->start_yaw) || !isfinite(r->start_yaw_rate)) {
    code = "invalid_input", message = "a number of the start or the goal is not finite";
  } else if (r->unknown > goshawk_msgs_msg_PlanRequest_Constants_UNKNOWN_COSTLY) {
    code = "invalid_input", message = "unknown must be 0, 1, 2 or 3";
  } else if (!(l->v_max > 0.0) || !(l->a_max > 0.0) ||
             l->norm > goshawk_msgs_msg_Limits_Constants_NORM_HORIZONTAL_VERTICAL) {
    code = "invalid_limits", message = "limits must be above zero, their norm 0, 1 or 2";
  } else if (r->deadline > 0.0 && waited_s > r->deadline) {
    code = "deadline_exceeded", message = "the deadline had passed when the request came";
  }
  if (strcmp(code, "ok") != 0) report(reports, r, code, message);
  return strcmp(code, "ok") == 0;
}

static void answer(dds_entity_t paths, dds_entity_t reports, const Grid* g, const Request* r) {
  const dds_time_t begin_ns = dds_time();
  if (!check(reports, r, begin_ns)) return;
  if (g == NULL) return report(reports, r, "no_map", "no map has come yet");
  const long start = voxel_of(g, r->start.position);
  const long goal = voxel_of(g, r->goal.position);
  if (start == OUTSIDE) return report(reports, r, "start_outside", "the start is off the map");
  if (start == OCCUPIED) return report(reports, r, "start_occupied", "the start is not free");
  if (goal == OUTSIDE) return report(reports, r, "goal_outside", "the goal is off the map");
  if (goal == OCCUPIED) return report(reports, r, "goal_occupied", "the goal is not free");
  long* parent = malloc((size_t)voxels(g) * sizeof *parent);
  long* queue = malloc((size_t)voxels(g) * sizeof *queue);
  Point* points = malloc((size_t)(voxels(g) + 4) * sizeof *points);
  if (!flood(g, start, goal, parent, queue)) {
    report(reports, r, "no_path", "the goal is cut off from the start");
  } else {
    goshawk_msgs_msg_Path m = {0};
    m.header.frame_id = "map";
    m.header.stamp.sec = (int32_t)(dds_time() / DDS_NSECS_IN_SEC);
    m.header.stamp.nanosec = (uint32_t)(dds_time() % DDS_NSECS_IN_SEC);
    m.request = *r;
    m.implementation = "cyclone_bfs";
    m.map_version = g->version;
    m.waypoints._buffer = points;
    m.waypoints._length = m.waypoints._maximum = corners(g, r, start, goal, parent, points);
    m.raw = m.waypoints;
    m.compute_ns = dds_time() - begin_ns;
    dds_write(paths, &m);
    report(reports, r, "ok", "");
  }
  free(points);
  free(queue);
  free(parent);
}

int main(void) {
  signal(SIGINT, stop);
  signal(SIGTERM, stop);
  const char* domain = getenv("ROS_DOMAIN_ID");
  const dds_entity_t dp =
      dds_create_participant(domain ? (dds_domainid_t)atoi(domain) : 0, NULL, NULL);
  const dds_entity_t maps = goshawk_reader(
      dp, goshawk_topic(dp, &goshawk_msgs_msg_VoxelGrid_desc,
                        "goshawk_msgs::msg::dds_::VoxelGrid_", "rt/map/voxels"), 1, true);
  const dds_entity_t requests = goshawk_reader(
      dp, goshawk_topic(dp, &goshawk_msgs_msg_PlanRequest_desc,
                        "goshawk_msgs::msg::dds_::PlanRequest_", "rt/plan_request"), 10, false);
  const dds_entity_t paths = goshawk_writer(
      dp, goshawk_topic(dp, &goshawk_msgs_msg_Path_desc, "goshawk_msgs::msg::dds_::Path_",
                        "rt/path"), 10, false);
  const dds_entity_t reports = goshawk_writer(
      dp, goshawk_topic(dp, &goshawk_msgs_msg_StageReport_desc,
                        "goshawk_msgs::msg::dds_::StageReport_", "rt/stage_report"), 20, true);
  report(reports, NULL, "ok", "ready: breadth first search in C over Cyclone DDS");
  void* grid = NULL;
  while (!stopped) {
    void* newer = goshawk_take(maps, 0.0);
    if (newer != NULL) {
      if (grid != NULL) dds_return_loan(maps, &grid, 1);
      grid = newer;
    }
    void* request = goshawk_take(requests, 0.02);
    if (request == NULL) continue;
    answer(paths, reports, grid, request);
    dds_return_loan(requests, &request, 1);
  }
  dds_delete(dp);
  return 0;
}
