#pragma once

#include "cli.hpp"

/// The verbs of the front door. Each takes the arguments behind it and returns an exit status.
namespace goshawk::cli {

int plan_command(const Arguments& arguments);
int world_command(const Arguments& arguments);
int fly_command(const Arguments& arguments);
int check_command(const Arguments& arguments);
int run_command(const Arguments& arguments);
int launch_command(const Arguments& arguments);
int campaign_command(const Arguments& arguments);
int view_command(const Arguments& arguments);
int conform_command(const Arguments& arguments);
int bench_command(const Arguments& arguments);
int bench_plan_command(const Arguments& arguments);

}  // namespace goshawk::cli
