#pragma once

#include "planning/map_options.hpp"
#include "program.hpp"

/// The verbs of `goshawk`: each describes its options to the parser and runs.
namespace goshawk::cli {

void add_fly(Program& program);
void add_goto(Program& program);
void add_hold(Program& program);
void add_resume(Program& program);
void add_land(Program& program);
void add_takeoff(Program& program);
void add_mission(Program& program);
void add_why(Program& program);
void add_plan(Program& program);
void add_check(Program& program);
void add_world(Program& program);
void add_map(Program& program);
void add_map_picture(const Verb& map);
void add_sense(Program& program);
void add_campaign(Program& program);
void add_launch(Program& program);
void add_place(Program& program);
void add_view(Program& program);
void add_run(Program& program);
void add_secure(Program& program);
void add_bench(Program& program);
void add_conform(Program& program);
void add_record(Program& program);
void add_replay(Program& program);
void add_bag(Program& program);
void add_interface(Program& program);
void add_topic(Program& program);
void add_node(Program& program);
void add_param(Program& program);
void add_doctor(Program& program);

/// What `bag record`, `bag play` and `bag info` share with `record` and `replay`.
void describe_record(const Verb& verb);
void describe_replay(const Verb& verb);
void describe_recording_info(const Verb& verb);

/// Options that several verbs share.
void add_map_options(const Verb& verb, MapOptions& options);

/// Whom the verbs for a running flight mean, and how long they wait.
struct VehicleOptions {
  std::string space = "/";
  double timeout_s = 120.0;
  double ready_s = 5.0;
};
void add_vehicle_options(const Verb& verb, VehicleOptions& options);

/// --timeout of verbs that look at the domain.
void add_timeout(const Verb& verb, double& timeout_s);

/// Completed words: installed components, installed launch files, topics and nodes of the domain.
Words component_names(const Words& before);
Words launch_files(const Words& before);
Words topic_names(const Words& before);
Words type_names(const Words& before);  // of messages, all that idl/ has
Words node_names(const Words& before);

}  // namespace goshawk::cli
